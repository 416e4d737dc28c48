// SPDX-License-Identifier: Apache-2.0
#include "shade/brick_runs.h"

#include <algorithm>
#include <glm/common.hpp>
#include <numeric>

namespace umbrick {

void BrickRuns::draw(const Draw& draw) const {
  std::vector<std::int32_t> all(origins_.size());
  std::iota(all.begin(), all.end(), 0);
  if (!all.empty()) split(all, draw);
}

bool BrickRuns::seesLowSideFirst(int axis, double plane) const {
  if (view_.projection == Projection::perspective) return view_.eyeIndex[axis] < plane;
  return view_.toIndex[2][axis] > 0;
}

void BrickRuns::split(std::span<std::int32_t> positions, const Draw& draw) const {
  if (draw(positions) || positions.size() == 1) return;
  const auto originOf = [&](std::int32_t position) -> const glm::ivec3& {
    return origins_[static_cast<std::size_t>(position)];
  };
  glm::i64vec3 low(originOf(positions.front())), high(low);
  for (const std::int32_t position : positions) {
    low = glm::min(low, glm::i64vec3(originOf(position)));
    high = glm::max(high, glm::i64vec3(originOf(position)));
  }
  const glm::i64vec3 extent = high - low;
  int axis = 0;
  for (int other = 1; other < 3; ++other)
    if (extent[other] > extent[axis]) axis = other;
  const auto along = [&](std::int32_t position) { return originOf(position)[axis]; };
  // About half of the bricks, but at least one, lies below the plane: bricks of one place stay together.
  const auto half = positions.begin() + static_cast<std::ptrdiff_t>(positions.size() / 2);
  std::ranges::nth_element(positions, half, {}, along);
  const int middle = along(*half);
  auto first = std::partition(positions.begin(), positions.end(), [&](std::int32_t p) { return along(p) < middle; });
  if (first == positions.begin())
    first = std::partition(positions.begin(), positions.end(), [&](std::int32_t p) { return along(p) <= middle; });
  const std::span<std::int32_t> below(positions.begin(), first), above(first, positions.end());
  const int plane = along(*std::ranges::min_element(above, {}, along));
  const bool lowFirst = seesLowSideFirst(axis, plane - 0.5);
  split(lowFirst ? below : above, draw);
  split(lowFirst ? above : below, draw);
}

}  // namespace umbrick
