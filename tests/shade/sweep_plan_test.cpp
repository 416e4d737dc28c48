// SPDX-License-Identifier: Apache-2.0
#include "shade/sweep_plan.h"

#include <array>
#include <catch2/catch.hpp>
#include <limits>
#include <random>
#include <set>

using namespace umbrick;

namespace {

std::set<std::int32_t> bricksOf(const ProxySlices& slices, std::int64_t first, std::int64_t last) {
  std::set<std::int32_t> bricks;
  for (auto p = static_cast<std::size_t>(slices.start[static_cast<std::size_t>(first)]);
       p < static_cast<std::size_t>(slices.start[static_cast<std::size_t>(last)]); ++p)
    bricks.insert(slices.polygons[p].brick);
  return bricks;
}

// Returns slices in which each brick is cut by a run of consecutive slices.
ProxySlices randomSlices(std::mt19937& random, int bricks, int count) {
  std::vector<std::vector<std::int32_t>> cut(static_cast<std::size_t>(count));
  for (std::int32_t brick = 0; brick < bricks; ++brick) {
    const int first = static_cast<int>(random() % static_cast<unsigned>(count));
    const int last = std::min(count - 1, first + static_cast<int>(random() % 6));
    for (int i = first; i <= last; ++i) cut[static_cast<std::size_t>(i)].push_back(brick);
  }
  ProxySlices slices;
  for (const auto& list : cut) {
    for (const std::int32_t brick : list) slices.polygons.push_back({brick, 0, 3});
    slices.start.push_back(static_cast<std::int32_t>(slices.polygons.size()));
  }
  return slices;
}

}  // namespace

TEST_CASE("Runs cover the sweep in order, each with its bricks and none longer than fits", "[shade]") {
  std::mt19937 random(5);
  for (int round = 0; round < 200; ++round) {
    const int bricks = 1 + static_cast<int>(random() % 40), count = 1 + static_cast<int>(random() % 30);
    const std::size_t slots = 1 + random() % 20;
    const ProxySlices slices = randomSlices(random, bricks, count);
    const std::vector<SweepRun> runs =
        planSweep(std::array<const ProxySlices*, 1>{&slices}, static_cast<std::size_t>(bricks), slots);
    INFO("round " << round << ", slots " << slots);
    REQUIRE_FALSE(runs.empty());
    CHECK(runs.front().first == 0);
    CHECK(runs.back().last == count);
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const SweepRun& run = runs[r];
      CHECK(run.first < run.last);
      if (r > 0) CHECK(run.first == runs[r - 1].last);
      const std::set<std::int32_t> needed = bricksOf(slices, run.first, run.last);
      CHECK(std::vector<std::int32_t>(needed.begin(), needed.end()) == run.bricks);
      // A run of more bricks than fit has only one slice with bricks.
      if (run.bricks.size() > slots) CHECK(bricksOf(slices, run.last - 1, run.last) == needed);
      // The run ended where the next slice would not fit.
      if (run.last < count) CHECK(bricksOf(slices, run.first, run.last + 1).size() > slots);
    }
  }
}

TEST_CASE("A volume that fits is swept in one run, and nothing in none", "[shade]") {
  std::mt19937 random(6);
  const ProxySlices slices = randomSlices(random, 30, 20);
  const auto runs = planSweep(std::array<const ProxySlices*, 1>{&slices}, 30, std::numeric_limits<std::size_t>::max());
  REQUIRE(runs.size() == 1);
  CHECK(runs[0].last == 20);
  CHECK(planSweep(std::vector<const ProxySlices*>{}, 0, 4).empty());
}
