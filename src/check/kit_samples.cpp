// SPDX-License-Identifier: Apache-2.0
#include "check/kit_samples.h"

#include <algorithm>
#include <numeric>

#include "umbrick/core/random.h"

namespace umbrick {
namespace {

glm::dvec3 uniformPoint(Random& random) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();  // in this order
  return {x, y, z};
}

// Returns a point of a brick's space of one of the kinds that chooseSamples() names.
glm::dvec3 pointOf(int kind, const glm::ivec3& origin, const glm::ivec3& interior, Random& random) {
  const glm::dvec3 low = glm::dvec3(origin) - 0.5, edge(interior);
  glm::dvec3 point = low + uniformPoint(random) * edge;
  const int first = static_cast<int>(random.next() % 3);
  const bool upper = random.next() % 2 == 0;
  // Moves the point along an axis to within a voxel's half of a face, on the inner side.
  const auto toFace = [&](int axis) {
    const double depth = 0.5 * random.uniform();
    point[axis] = upper ? low[axis] + edge[axis] - depth : low[axis] + depth;
  };
  switch (kind) {
    case 0:
      return glm::round(point);
    case 1:
      return point;
    case 2:  // exactly on the face between two bricks
      point[first] = low[first];
      return point;
    default:  // at a face (3), an edge (4) or a corner (5)
      for (int i = 0; i < kind - 2; ++i) toFace((first + i) % 3);
      return point;
  }
}

}  // namespace

SamplePlace placeOf(const BrickFinder& bricks, const glm::dvec3& index) {
  if (bricks.at(index) < 0) return SamplePlace::outside;
  return bricks.needsApron(index) ? SamplePlace::border : SamplePlace::inside;
}

std::vector<KitSample> chooseSamples(const VoxelAt& voxel, const BrickFinder& bricks,
                                     const std::vector<glm::ivec3>& origins, const IndexBox& domain, std::size_t count,
                                     unsigned seed) {
  Random random(seed);
  std::vector<std::size_t> order(origins.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  // Where there are more bricks than samples, those that are asked lie everywhere.
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.next() % i]);
  std::vector<KitSample> samples;
  const auto add = [&](const glm::dvec3& index) {
    samples.push_back({index, bricks.at(index), placeOf(bricks, index), trilinear(voxel, index)});
  };
  constexpr int kKinds = 6;
  const std::size_t outside = count / 12;
  for (std::size_t i = 0; i + outside < count; ++i) {
    // The kind changes with each round through the bricks, and from brick to brick.
    const std::size_t round = i / origins.size(), brick = i % origins.size();
    const int kind = static_cast<int>((round + brick) % kKinds);
    add(pointOf(kind, origins[order[brick]], bricks.interior(), random));
  }
  const glm::dvec3 low = glm::dvec3(domain.min) - 4.0, extent = glm::dvec3(domain.extent()) + 8.0;
  for (std::size_t i = 0; i < outside; ++i) add(low + uniformPoint(random) * extent);
  return samples;
}

}  // namespace umbrick
