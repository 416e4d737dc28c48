// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/isosurface.h"

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/FastSweeping.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/Morphology.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <vector>

#include "grid/isosurface_error.h"
#include "grid/sparse_rule.h"
#include "grid/surface_band.h"
#include "grid/surface_distance.h"
#include "umbrick/core/error.h"
#include "umbrick/core/memory.h"
#include "umbrick/core/range.h"
#include "umbrick/grid/affine_matrix.h"
#include "umbrick/grid/change_values.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {
namespace {

using openvdb::FloatGrid;

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

// Refuses what is too large for the memory: where spacings differ much, each edge of the volume that crosses the value
// is stretched over many cubes. Voxels near the surface get values, those of the band distances, and each cube of the
// surface some discs; twice as much, since they are copied when the parts of threads are joined. Spheres of 96^3 voxels
// with spacings of 1 : 1 : 10 to 1 : 1 : 100 and 0.1 : 1 : 1 took 0.85 to 0.95 of it.
// @param crossings  of the edges along each axis
void checkBand(const ScalarGrid& volume, const IsosurfaceOptions& options,
               const std::array<std::uint64_t, 3>& crossings, const glm::dmat4& toLevelSet) {
  const glm::dmat3 axes(toLevelSet);
  const double cell = std::abs(glm::determinant(axes));  // voxels of the level set in one of the volume
  double area = 0, near = 0;                             // in voxels of the level set
  for (int axis = 0; axis < 3; ++axis) {
    const auto count = static_cast<double>(crossings[static_cast<std::size_t>(axis)]);
    area += count * glm::length(glm::cross(axes[(axis + 1) % 3], axes[(axis + 2) % 3]));
    near += count * cell;
  }
  // Leaves reach a few voxels beyond the band; a surface voxel has one to three discs.
  constexpr double kLeafVoxel = 5, kDiscs = 2 * sizeof(Disc);  // bytes, with masks
  const double band = area * (2 * double(options.halfWidth) + 6);
  std::ostringstream step;
  step.precision(3);
  step << "grid \"" << volume.name << "\": isosurface: a band of some " << band << " cubes of the smallest spacing";
  requireMemory(step.str(), 2 * (kLeafVoxel * (band + 2 * near) + kDiscs * area));
}

// Returns the value at a voxel of another lattice.
template <class Access>
float sampleAt(const Access& volume, const glm::dmat4& toVolume, const openvdb::Coord& at) {
  const glm::dvec4 p = toVolume * glm::dvec4(at.x(), at.y(), at.z(), 1);
  return openvdb::tools::BoxSampler::sample(volume, openvdb::Vec3d(p.x, p.y, p.z));
}

// Returns the volume at some voxels of another lattice, which are active.
FloatGrid::Ptr sampled(const FloatGrid& volume, const openvdb::MaskTree& band, const glm::dmat4& toVolume) {
  const auto fog =
      FloatGrid::create(std::make_shared<openvdb::FloatTree>(band, volume.background(), openvdb::TopologyCopy()));
  openvdb::tree::LeafManager<openvdb::FloatTree> leaves(fog->tree());
  leaves.foreach ([&](openvdb::FloatTree::LeafNodeType& leaf, std::size_t) {
    const auto access = volume.getConstAccessor();
    for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) voxel.setValue(sampleAt(access, toVolume, voxel.getCoord()));
  });
  return fog;
}

// Makes a band wider, by sweeps that solve the eikonal equation to first order (OpenVDB's FastSweeping.h, after Zhao,
// "A fast sweeping method for Eikonal equations", 2004).
FloatGrid::Ptr widened(const FloatGrid& band, float halfWidth) {
  const int more = static_cast<int>(std::ceil(halfWidth - band.background()));
  const FloatGrid::Ptr wide = openvdb::tools::dilateSdf(band, more, openvdb::tools::NN_FACE_EDGE_VERTEX);
  openvdb::tools::changeLevelSetBackground(wide->tree(), halfWidth);
  openvdb::tree::LeafManager<openvdb::FloatTree> leaves(wide->tree());
  leaves.foreach ([halfWidth](openvdb::FloatTree::LeafNodeType& leaf, std::size_t) {
    for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) {
      if (std::abs(*voxel) < halfWidth) continue;
      voxel.setValue(std::copysign(halfWidth, *voxel));
      voxel.setValueOff();
    }
  });
  openvdb::tools::pruneInactive(wide->tree());
  openvdb::tools::signedFloodFill(wide->tree());
  return wide;
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
  const glm::dmat4 before = volume.indexToWorld(), place = cubicPlace(before);
  const glm::dmat4 toLevelSet = place == before ? glm::dmat4(1) : glm::inverse(place) * before;
  const std::array<std::uint64_t, 3> crossings = countCrossings(volume.grid->tree(), options.value);
  if (crossings == std::array<std::uint64_t, 3>{}) {
    const Range range = rangeOf(volume.grid->tree());
    refuse(volume, "expected a value that the volume crosses, from ", range.min, " to ", range.max, ", found ",
           options.value);
  }
  const bool same = place == before;
  if (!same) checkBand(volume, options, crossings, toLevelSet);
  const glm::dmat4 toVolume = glm::inverse(toLevelSet);
  const auto isInside = [&]() -> std::function<bool(const openvdb::Coord&)> {
    return [access = volume.grid->getConstAccessor(), toVolume, same, value = options.value](const openvdb::Coord& at) {
      return (same ? access.getValue(at) : sampleAt(access, toVolume, at)) >= value;
    };
  };
  std::vector<LeafDiscs> discs = surfaceDiscs(volume.grid->tree(), options.value, /*activeOnly=*/false, toLevelSet);
  if (!same) {
    // Edges of the volume are longer than those of the level set, which needs a disc for each of its own edges too.
    openvdb::MaskTree band = surfaceVoxels(volume.grid->tree(), options.value, toLevelSet);
    openvdb::tools::dilateActiveValues(band, 1);
    const auto fog = sampled(*volume.grid, band, toVolume);
    const auto between = surfaceDiscs(fog->tree(), options.value, /*activeOnly=*/true);
    discs.insert(discs.end(), between.begin(), between.end());
  }
  Isosurface out;
  out.grid = distanceBand(discs, std::min(options.halfWidth, kMostDirect), isInside);
  if (options.halfWidth > kMostDirect) out.grid = widened(*out.grid, options.halfWidth);
  out.grid->setTransform(transformOf(*volume.grid, before, place));
  // Distances in voxels become distances in the world.
  const double voxel = glm::length(glm::dvec3(place[0]));
  changeValues(out.grid->tree(), [voxel](float distance) { return static_cast<float>(voxel * double(distance)); });
  measureIsosurface(volume.grid->tree(), options.value, *out.grid, toLevelSet, out.report);
  out.report.voxelSize = voxel;
  out.report.activeVoxels = out.grid->activeVoxelCount();
  out.report.leaves = out.grid->tree().leafCount();
  describeSurface(*out.grid, *volume.grid, options, out.report);
  return out;
}

}  // namespace umbrick
