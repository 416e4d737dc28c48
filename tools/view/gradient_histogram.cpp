// SPDX-License-Identifier: Apache-2.0
#include "view/gradient_histogram.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <utility>

#include "umbrick/grid/float_grid.h"

namespace umbrick::view {
namespace {

constexpr std::size_t kMostVoxels = 1 << 20;  // that are looked at

using Pair = std::pair<float, float>;  // value and gradient magnitude

std::vector<Pair> samplePairs(const ScalarGrid& grid) {
  const openvdb::FloatTree& tree = grid.grid->tree();
  const std::size_t every = std::max<std::size_t>(1, tree.activeLeafVoxelCount() / kMostVoxels);
  // A gradient of the index space becomes one of the world by the inverse of the transpose.
  const glm::dmat3 toWorld = glm::transpose(glm::inverse(glm::dmat3(grid.indexToWorld())));
  auto at = grid.grid->getConstAccessor();
  std::vector<Pair> pairs;
  std::size_t leaves = 0;
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
    if (leaves++ % every != 0) continue;
    for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) {
      const openvdb::Coord c = voxel.getCoord();
      glm::dvec3 gradient(0);
      for (int axis = 0; axis < 3; ++axis) {
        openvdb::Coord step(0);
        step[axis] = 1;
        gradient[axis] = 0.5 * (double(at.getValue(c + step)) - double(at.getValue(c - step)));
      }
      const double length = glm::length(toWorld * gradient);
      if (std::isfinite(*voxel) && std::isfinite(length)) pairs.emplace_back(*voxel, static_cast<float>(length));
    }
  }
  return pairs;
}

double topOf(const std::vector<Pair>& pairs) {
  std::vector<float> lengths;
  lengths.reserve(pairs.size());
  for (const Pair& pair : pairs) lengths.push_back(pair.second);
  if (lengths.empty()) return 1;
  const auto place = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() - 1 - lengths.size() / 2000);
  std::nth_element(lengths.begin(), place, lengths.end());
  if (*place > 0) return *place;
  const float most = *std::max_element(lengths.begin(), lengths.end());
  return most > 0 ? most : 1;  // a grid of one value has no gradient
}

}  // namespace

GradientHistogram surveyGradients(const ScalarGrid& grid, double low, double high) {
  const std::vector<Pair> pairs = samplePairs(grid);
  GradientHistogram found;
  found.low = low;
  found.high = high;
  found.most = topOf(pairs);
  found.counts.assign(static_cast<std::size_t>(found.values) * static_cast<std::size_t>(found.gradients), 0.0);
  const auto binOf = [](double share, int bins) {
    return static_cast<std::size_t>(std::clamp(share * bins, 0.0, bins - 1.0));
  };
  for (const auto& [value, length] : pairs)
    found.counts[binOf(length / found.most, found.gradients) * static_cast<std::size_t>(found.values) +
                 binOf((value - low) / (high - low), found.values)] += 1;
  return found;
}

}  // namespace umbrick::view
