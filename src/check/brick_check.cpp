// SPDX-License-Identifier: Apache-2.0
#include "check/brick_check.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <numeric>
#include <random>

#include "check/result.h"

namespace umbrick {
namespace {

// One check reads about so many voxels, which takes a few seconds.
constexpr std::size_t kVoxelsRead = std::size_t{1} << 30;

// Returns the bricks to look at, in order: all, or `most` of them.
std::vector<std::size_t> chooseBricks(std::size_t count, std::size_t most, unsigned seed) {
  std::vector<std::size_t> all(count), chosen;
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::mt19937 random(seed);
  std::sample(all.begin(), all.end(), std::back_inserter(chosen), most, random);
  return chosen;
}

std::string printOrigin(const glm::ivec3& origin) {
  return "(" + std::to_string(origin.x) + ", " + std::to_string(origin.y) + ", " + std::to_string(origin.z) + ")";
}

struct Voxels {
  std::vector<float> values, gradients;
  void read(const Bricks& bricks, const glm::ivec3& origin) {
    values.resize(bricks.layout.voxels());
    if (bricks.hasGradients) gradients.resize(bricks.layout.voxels());
    bricks.read(origin, values, gradients);
  }
};

// Calls visit(index in the array of voxels) for each voxel at [low, high) from the brick's first owned voxel.
template <class Visit>
void forEachVoxel(const BrickLayout& layout, const glm::ivec3& low, const glm::ivec3& high, const Visit& visit) {
  const glm::ivec3 edge = layout.edge();
  for (int z = low.z; z < high.z; ++z)
    for (int y = low.y; y < high.y; ++y)
      for (int x = low.x; x < high.x; ++x) {
        const glm::i64vec3 at = glm::i64vec3(x, y, z) + std::int64_t(layout.apron);
        visit(static_cast<std::size_t>((at.z * edge.y + at.y) * edge.x + at.x));
      }
}

// Returns how many voxels of the apron towards one neighbour differ from the neighbour's own.
std::size_t countDifferences(const BrickLayout& layout, const Voxels& brick, const Voxels& neighbour,
                             const glm::ivec3& direction, std::size_t& compared) {
  glm::ivec3 low, high;
  for (int axis = 0; axis < 3; ++axis) {
    const int interior = layout.interior[axis];
    low[axis] = direction[axis] < 0 ? -layout.apron : direction[axis] > 0 ? interior : 0;
    high[axis] = direction[axis] < 0 ? 0 : direction[axis] > 0 ? interior + layout.apron : interior;
  }
  // The same voxel has another place in the neighbour's array.
  const glm::i64vec3 shift = glm::i64vec3(direction) * glm::i64vec3(layout.interior);
  const glm::i64vec3 edge(layout.edge());
  const std::int64_t offset = (shift.z * edge.y + shift.y) * edge.x + shift.x;
  std::size_t different = 0;
  forEachVoxel(layout, low, high, [&](std::size_t here) {
    const auto there = static_cast<std::size_t>(static_cast<std::int64_t>(here) - offset);
    bool same = brick.values[here] == neighbour.values[there];
    if (!brick.gradients.empty()) same = same && brick.gradients[here] == neighbour.gradients[there];
    different += !same;
    ++compared;
  });
  return different;
}

// Calls visit(i) for all i below `count` on all cores, and says now and then how far the step is.
// @param from, to  shares of the step that are done before and after
template <class Visit>
void visitAll(std::size_t count, const CheckSteps& steps, double from, double to, const Visit& visit) {
  const std::size_t batch = std::max<std::size_t>(16, count / 64);
  for (std::size_t first = 0; first < count; first += batch) {
    steps.within(from + (to - from) * static_cast<double>(first) / static_cast<double>(count));
    tbb::parallel_for(tbb::blocked_range<std::size_t>(first, std::min(count, first + batch), 1),
                      [&](const auto& range) {
                        for (std::size_t i = range.begin(); i != range.end(); ++i) visit(i);
                      });
  }
}

// Adds what was counted in each of the chosen bricks.
void addCounts(const Bricks& bricks, const std::vector<std::size_t>& chosen, const std::vector<std::size_t>& counts,
               std::size_t samples, InvariantResult& result) {
  const auto worst = std::max_element(counts.begin(), counts.end());
  std::string detail = std::to_string(chosen.size()) + " of " + std::to_string(bricks.bricks.size()) + " bricks of " +
                       std::to_string(bricks.layout.interior.x);
  if (worst != counts.end() && *worst > 0)
    detail +=
        ", brick at " + printOrigin(bricks.bricks[chosen[static_cast<std::size_t>(worst - counts.begin())]].origin);
  addMeasurement(result, static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::size_t{0})), 0, samples,
                 detail);
}

}  // namespace

void checkAprons(const Bricks& bricks, std::size_t most, unsigned seed, const CheckSteps& steps,
                 InvariantResult& result) {
  const BrickLayout& layout = bricks.layout;
  const std::size_t affordable = std::max<std::size_t>(8, kVoxelsRead / (27 * layout.voxels()));
  const std::vector<std::size_t> chosen = chooseBricks(bricks.bricks.size(), std::min(most, affordable), seed);
  std::vector<std::size_t> different(chosen.size(), 0);
  std::atomic<std::size_t> compared{0};
  tbb::enumerable_thread_specific<std::array<Voxels, 2>> scratches;
  visitAll(chosen.size(), steps, 0, 0.9, [&](std::size_t i) {
    auto& [brick, neighbour] = scratches.local();
    const glm::ivec3 origin = bricks.bricks[chosen[i]].origin;
    brick.read(bricks, origin);
    std::size_t voxels = 0;
    for (int direction = 0; direction < 27; ++direction) {
      const glm::ivec3 towards = glm::ivec3(direction % 3, direction / 3 % 3, direction / 9) - 1;
      if (towards == glm::ivec3(0)) continue;
      neighbour.read(bricks, origin + towards * layout.interior);
      different[i] += countDifferences(layout, brick, neighbour, towards, voxels);
    }
    compared += voxels;
  });
  addCounts(bricks, chosen, different, compared, result);
}

void checkRanges(const Bricks& bricks, std::size_t most, unsigned seed, const CheckSteps& steps,
                 InvariantResult& result) {
  const std::size_t affordable = std::max<std::size_t>(8, kVoxelsRead / bricks.layout.voxels());
  const std::vector<std::size_t> chosen = chooseBricks(bricks.bricks.size(), std::min(most, affordable), seed);
  std::vector<std::size_t> outside(chosen.size(), 0);
  tbb::enumerable_thread_specific<Voxels> scratches;
  visitAll(chosen.size(), steps, 0.9, 1, [&](std::size_t i) {
    Voxels& voxels = scratches.local();
    const Brick& brick = bricks.bricks[chosen[i]];
    voxels.read(bricks, brick.origin);
    const auto count = [](const std::vector<float>& values, const Range& within) {
      return static_cast<std::size_t>(
          std::count_if(values.begin(), values.end(), [&](float v) { return !within.contains(v); }));
    };
    outside[i] = count(voxels.values, brick.value) + count(voxels.gradients, brick.gradient);
  });
  addCounts(bricks, chosen, outside, chosen.size() * bricks.layout.voxels(), result);
}

}  // namespace umbrick
