// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/emission_grid.h"

#include <openvdb/tools/GridTransformer.h>
#include <openvdb/tools/Interpolation.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "umbrick/grid/float_grid.h"

namespace umbrick {
namespace {

// How far corners of the second grid lie from the same indices of the first, voxels.
double largestShift(const ScalarGrid& first, const ScalarGrid& second) {
  const IndexBox box = second.activeBox();
  if (box.empty()) return 0;
  const glm::dmat4 toFirst = glm::inverse(first.indexToWorld()) * second.indexToWorld();
  double largest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    glm::dvec4 at(0, 0, 0, 1);
    for (int axis = 0; axis < 3; ++axis) at[axis] = corner >> axis & 1 ? box.max[axis] : box.min[axis];
    const glm::dvec4 shift = glm::abs(toFirst * at - at);
    largest = std::max({largest, shift.x, shift.y, shift.z});
  }
  return largest;
}

// What voxels of a grid differ by from the same places of another one.
struct Differences {
  double max = 0, squares = 0;
  std::uint64_t count = 0;
};

Differences differences(const openvdb::FloatGrid& stored, const openvdb::FloatGrid& resampled) {
  using Leaf = openvdb::FloatTree::LeafNodeType;
  std::vector<const Leaf*> leaves;
  stored.tree().getNodes(leaves);
  tbb::enumerable_thread_specific<Differences> all;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, leaves.size(), 16), [&](const auto& range) {
    Differences& mine = all.local();
    const auto accessor = resampled.getConstAccessor();
    for (std::size_t i = range.begin(); i != range.end(); ++i)
      for (auto voxel = leaves[i]->cbeginValueOn(); voxel; ++voxel) {
        if (!std::isfinite(*voxel)) continue;
        const openvdb::Vec3d place = resampled.worldToIndex(stored.indexToWorld(voxel.getCoord()));
        const double off = std::abs(double(*voxel) - double(openvdb::tools::BoxSampler::sample(accessor, place)));
        mine.max = std::max(mine.max, off);
        mine.squares += off * off;
        ++mine.count;
      }
  });
  Differences sum;
  for (const Differences& mine : all) {
    sum.max = std::max(sum.max, mine.max);
    sum.squares += mine.squares;
    sum.count += mine.count;
  }
  return sum;
}

}  // namespace

EmissionReport addEmission(ScalarGrid& first, const ScalarGrid& second) {
  constexpr double kSamePlace = 1e-3;  // voxels
  if (largestShift(first, second) <= kSamePlace) {
    first.emission = second.grid;
    return {};
  }
  const auto resampled = openvdb::FloatGrid::create(second.grid->background());
  resampled->setTransform(first.grid->transform().copy());
  openvdb::tools::resampleToMatch<openvdb::tools::BoxSampler>(*second.grid, *resampled);
  const Differences off = differences(*second.grid, *resampled);
  first.emission = resampled;
  return {true, off.max, off.count > 0 ? std::sqrt(off.squares / static_cast<double>(off.count)) : 0};
}

}  // namespace umbrick
