// SPDX-License-Identifier: Apache-2.0
#include "umbrick/vdb/read_back.h"

#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "umbrick/core/error.h"
#include "umbrick/core/patient_space.h"
#include "umbrick/grid/affine_matrix.h"
#include "umbrick/grid/grid_world.h"
#include "umbrick/grid/misplaced.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/ingest/open_volume.h"
#include "umbrick/vdb/grid_listing.h"
#include "umbrick/vdb/read_grid.h"
#include "umbrick/vdb/read_vectors.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;

FloatGrid::ConstPtr readDense(const fs::path& file, const FloatGrid& written) {
  const openvdb::CoordBBox box = written.evalActiveVoxelBoundingBox();
  OpenOptions open;
  const World world = worldOf(written);
  for (const char* known : {"nm", "um", "mm", "cm", "m"})
    if (world.lengthUnit == known) open.lengthUnit = known;
  if (patientAxes(world.space)) open.space = world.space;
  const auto source = openVolume(file, open);
  const VolumeInfo& info = source->info();
  const glm::i64vec3 dims(box.dim().x(), box.dim().y(), box.dim().z());
  if (info.dims != dims) throw IoError(info.name + ": dims: expected those of the active voxels, found others");
  const FloatGrid::Ptr grid = written.deepCopy();
  grid->setTransform(openvdb::math::Transform::createLinearTransform(rowMatrix(info.indexToWorld)));
  grid->transform().preTranslate(-box.min().asVec3d());
  auto access = grid->getAccessor();
  std::vector<float> slice(static_cast<std::size_t>(dims.x * dims.y));
  for (int z = 0; z < dims.z; ++z) {
    source->readSlab(1, slice);
    auto value = slice.begin();
    for (int y = 0; y < dims.y; ++y)
      for (int x = 0; x < dims.x; ++x, ++value) {
        const Coord at = box.min().offsetBy(x, y, z);
        if (access.getValue(at) != *value) access.setValue(at, *value);
      }
  }
  return grid;
}

// Tells by the first bytes, since a file that has not taken its name may have none.
bool isDense(const fs::path& file) {
  char first[5]{};
  std::ifstream(file, std::ios::binary).read(first, sizeof first);
  const std::string_view text(first, sizeof first);
  return text.starts_with("NRRD") || text.starts_with("Objec");
}

// Checks what a grid has besides its values.
template <class Grid>
void checkBack(const fs::path& file, const Grid& written, const Grid& found) {
  const std::string name = file.string() + ": grid \"" + written.getName() + '"';
  if (found.background() != written.background()) {
    std::ostringstream text;
    text << name << ": background: expected " << written.background() << ", found " << found.background();
    throw IoError(text.str());
  }
  if (const auto other = misplacedCorner(written, found, 1e-6))
    throw IoError(name + ": place of voxel " + vectorText(other->voxel) + ": expected " + vectorText(other->expected) +
                  ", found " + vectorText(other->found));
}

// The label of a grid by its place in the file.
std::string labelAt(const fs::path& file, std::size_t index) {
  const GridListing listing = listGrids(file);
  if (index >= listing.grids.size())
    throw IoError(file.string() + ": expected " + std::to_string(index + 1) + " grids or more, found " +
                  std::to_string(listing.grids.size()));
  return listing.grids[index].label;
}

}  // namespace

FloatGrid::ConstPtr readBack(const fs::path& file, const FloatGrid& written, std::size_t index) {
  const FloatGrid::ConstPtr found =
      isDense(file) ? readDense(file, written) : readScalarGridAnyTransform(file, labelAt(file, index)).grid;
  checkBack(file, written, *found);
  return found;
}

openvdb::Vec3SGrid::ConstPtr readVectorsBack(const fs::path& file, const openvdb::Vec3SGrid& written,
                                             std::size_t index) {
  const openvdb::Vec3SGrid::ConstPtr found = readVectorGrid(file, labelAt(file, index));
  checkBack(file, written, *found);
  return found;
}

}  // namespace umbrick
