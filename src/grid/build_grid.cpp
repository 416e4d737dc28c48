// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/build_grid.h"

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <future>
#include <memory>
#include <sstream>

#include "grid/slab_builder.h"
#include "grid/sparse_rule.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/affine_matrix.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {
namespace {

openvdb::math::Transform::Ptr makeTransform(const std::string& name, const glm::dmat4& indexToWorld) {
  using namespace openvdb::math;
  const glm::dmat4& m = indexToWorld;
  const Mat4d map = rowMatrix(m);
  bool diagonal = true;
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < 3; ++i) diagonal = diagonal && (axis == i || m[axis][i] == 0);
  // A grid that needs no more than scale and translation gets a map of just these, so that programs which know no other
  // map can place it.
  const Vec3d scale(m[0][0], m[1][1], m[2][2]), origin(m[3][0], m[3][1], m[3][2]);
  try {
    MapBase::Ptr base;
    if (diagonal && scale[0] == scale[1] && scale[1] == scale[2])
      base = std::make_shared<UniformScaleTranslateMap>(scale[0], origin);
    else if (diagonal)
      base = std::make_shared<ScaleTranslateMap>(scale, origin);
    else
      base = std::make_shared<AffineMap>(map);
    return std::make_shared<Transform>(base);
  } catch (const openvdb::Exception&) {
    std::ostringstream text;
    text << name << ": spacing: expected voxels of at least 3e-15 cubed world units (OpenVDB allows no less), found "
         << std::abs(map.getMat3().det()) << "; use a smaller unit of length";
    throw InvalidArgument(text.str());
  }
}

openvdb::FloatGrid::Ptr emptyGrid(const VolumeInfo& info, const BuildOptions& options, float background) {
  auto grid = openvdb::FloatGrid::create(background);
  for (const auto& [key, value] : info.metadata)
    if (!key.empty()) grid->insertMeta(key, openvdb::StringMetadata(value));
  grid->setName(options.name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setTransform(makeTransform(info.name, info.indexToWorld));
  grid->setSaveFloatAsHalf(options.half);
  return grid;
}

}  // namespace

BuiltGrid buildGrid(VoxelSource& source, const BuildOptions& options) {
  openvdb::initialize();
  const VolumeInfo& info = source.info();
  const SparseRule rule(info.name, options, 0);
  BuiltGrid built{emptyGrid(info, options, rule.background()), {}};
  const std::int64_t sliceVoxels = info.dims.x * info.dims.y;
  const std::int64_t atOnce = slabSlices(info.dims);
  checkSlabFits(info, std::min(atOnce, info.dims.z));

  SlabBuilder builder(info.dims, rule);
  SparseTally tally;
  VoxelSlab slab(source), next(source);
  built.report.conversionError = slab.read(0, atOnce);
  while (slab.slices() > 0) {
    // The next voxel slab is read while the leaves of this one are built.
    auto reading = std::async(std::launch::async, [&] { return next.read(slab.firstSlice() + slab.slices(), atOnce); });
    tally.add(builder.addTo(built.grid->tree(), slab));
    built.report.conversionError = std::max(built.report.conversionError, reading.get());
    slab.swap(next);
    if (options.progress) options.progress(static_cast<double>(slab.firstSlice()) / static_cast<double>(info.dims.z));
  }
  BuildOptions stored = options;
  if (options.maxError) {
    stored = storageWithin(built.grid->tree(), options);
    tally.add(sparsifyTree(built.grid->tree(), SparseRule(info.name, stored, rule.background())));
    built.grid->setSaveFloatAsHalf(stored.half);
  }
  checkTally(info.name, tally);
  // Equal neighbours become larger tiles, which adds no error to that of the leaves.
  openvdb::tools::prune(built.grid->tree());
  built.report.voxels = static_cast<std::uint64_t>(sliceVoxels) * static_cast<std::uint64_t>(info.dims.z);
  describe(*built.grid, tally, stored, built.report);
  return built;
}

}  // namespace umbrick
