// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/isosurface.h"

#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "grid/isosurface_error.h"
#include "grid/sparse_rule.h"
#include "umbrick/core/error.h"
#include "umbrick/core/range.h"
#include "umbrick/grid/affine_matrix.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {
namespace {

using openvdb::FloatGrid;
using Points = std::vector<openvdb::Vec3s>;
using Quads = std::vector<openvdb::Vec4I>;

template <class... Parts>
[[noreturn]] void refuse(const ScalarGrid& volume, const Parts&... parts) {
  std::ostringstream text;
  text.precision(9);
  text << "grid \"" << volume.name << "\": isosurface: ";
  (text << ... << parts);
  throw InvalidArgument(text.str());
}

void check(const ScalarGrid& volume, const IsosurfaceOptions& options) {
  const float background = volume.grid->background();
  if (!std::isfinite(options.value)) refuse(volume, "expected a finite value, found ", options.value);
  if (!(options.halfWidth >= 1 && options.halfWidth <= 100))
    refuse(volume, "expected a half width from 1 to 100 voxels, found ", options.halfWidth);
  if (volume.grid->getGridClass() == openvdb::GRID_LEVEL_SET)
    refuse(volume, "expected a fog volume, found a level set");
  if (options.value <= background)
    refuse(volume, "expected a value above the background of ", background, ", which is outside, found ",
           options.value);
}

Range rangeOf(const openvdb::FloatTree& tree) {
  Range range;
  range.include(tree.background());
  for (auto value = tree.cbeginValueOn(); value; ++value)
    if (std::isfinite(*value)) range.include(*value);
  return range;
}

// Meshes the surface in index coordinates of the volume, since world coordinates of 32 bits are too coarse far
// from the origin.
void mesh(const FloatGrid& volume, float value, Points& points, Quads& quads) {
  const auto unplaced = FloatGrid::create(std::const_pointer_cast<openvdb::FloatTree>(volume.treePtr()));
  openvdb::tools::volumeToMesh(*unplaced, points, quads, value);
}

// Returns a transform whose voxels are cubes of the smallest spacing, as a matrix for column vectors from
// index to world.
glm::dmat4 cubicPlace(const glm::dmat4& place) {
  constexpr double kRounding = 1e-6;  // headers of few digits round
  double smallest = glm::length(glm::dvec3(place[0])), largest = smallest;
  bool rightAngles = true;
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 column(place[axis]), next(place[(axis + 1) % 3]);
    smallest = std::min(smallest, glm::length(column));
    largest = std::max(largest, glm::length(column));
    rightAngles =
        rightAngles && std::abs(glm::dot(column, next)) <= kRounding * glm::length(column) * glm::length(next);
  }
  if (rightAngles && largest - smallest <= kRounding * smallest) return place;
  glm::dmat4 cubic = place;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec4 direction(0);
    direction[axis] = 1;
    cubic[axis] = smallest * (rightAngles ? place[axis] / glm::length(glm::dvec3(place[axis])) : direction);
  }
  return cubic;
}

openvdb::math::Transform::Ptr transformOf(const FloatGrid& volume, const glm::dmat4& before, const glm::dmat4& place) {
  if (place == before) return volume.transform().copy();
  return openvdb::math::Transform::createLinearTransform(rowMatrix(place));
}

// Makes distances, which have no sign yet, negative where the volume has the value or more.
void setSigns(FloatGrid& levelSet, const FloatGrid& volume, float value, const glm::dmat4& toVolume) {
  openvdb::tree::LeafManager<openvdb::FloatTree> leaves(levelSet.tree());
  leaves.foreach ([&](openvdb::FloatTree::LeafNodeType& leaf, std::size_t) {
    const auto access = volume.getConstAccessor();
    for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) {
      const openvdb::Coord at = voxel.getCoord();
      const glm::dvec4 p = toVolume * glm::dvec4(at.x(), at.y(), at.z(), 1);
      const float here = openvdb::tools::BoxSampler::sample(access, openvdb::Vec3d(p.x, p.y, p.z));
      const float distance = std::abs(*voxel);
      voxel.setValue(here >= value ? -distance : distance);
    }
  });
  openvdb::tools::signedFloodFill(levelSet.tree());
}

void describeSurface(FloatGrid& levelSet, const FloatGrid& volume, const IsosurfaceOptions& options,
                     const IsosurfaceReport& report) {
  levelSet.insertMeta(volume);
  levelSet.removeMeta("storage");
  levelSet.setGridClass(openvdb::GRID_LEVEL_SET);
  levelSet.setSaveFloatAsHalf(false);
  levelSet.insertMeta("isosurface_value", openvdb::DoubleMetadata(double(options.value)));
  levelSet.insertMeta("isosurface_error_max", openvdb::DoubleMetadata(report.maxError));
  levelSet.insertMeta("isosurface_error_rms", openvdb::DoubleMetadata(report.rmsError));
}

}  // namespace

Isosurface makeIsosurface(const ScalarGrid& volume, const IsosurfaceOptions& options) {
  openvdb::initialize();
  check(volume, options);
  Points points;
  Quads quads;
  mesh(*volume.grid, options.value, points, quads);
  if (quads.empty()) {
    const Range range = rangeOf(volume.grid->tree());
    refuse(volume, "expected a value that the volume crosses, from ", range.min, " to ", range.max, ", found ",
           options.value);
  }
  const glm::dmat4 before = volume.indexToWorld(), place = cubicPlace(before);
  const glm::dmat4 toLevelSet = place == before ? glm::dmat4(1) : glm::inverse(place) * before;
  for (openvdb::Vec3s& point : points) {
    const glm::dvec4 p = toLevelSet * glm::dvec4(point[0], point[1], point[2], 1);
    point = openvdb::Vec3s(float(p.x), float(p.y), float(p.z));
  }
  const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec4I> surface(points, quads);
  Isosurface out;
  out.grid = openvdb::tools::meshToVolume<FloatGrid>(
      surface, *transformOf(*volume.grid, before, place), options.halfWidth, options.halfWidth,
      openvdb::tools::UNSIGNED_DISTANCE_FIELD | openvdb::tools::DISABLE_RENORMALIZATION);
  setSigns(*out.grid, *volume.grid, options.value, glm::inverse(toLevelSet));
  measureIsosurface(volume.grid->tree(), options.value, *out.grid, toLevelSet, out.report);
  out.report.voxelSize = glm::length(glm::dvec3(place[0]));
  out.report.activeVoxels = out.grid->activeVoxelCount();
  out.report.leaves = out.grid->tree().leafCount();
  describeSurface(*out.grid, *volume.grid, options, out.report);
  return out;
}

}  // namespace umbrick
