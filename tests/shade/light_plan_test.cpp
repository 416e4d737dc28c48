// Compares what the light's windows hold with a sweep that keeps every path for ever.
// SPDX-License-Identifier: Apache-2.0
#include "shade/light_plan.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <utility>

#include "shade/random_light.h"

using namespace umbrick;

namespace {

using Texel = std::pair<std::int64_t, std::int64_t>;
using Whole = glm::vec<2, std::int64_t>;

Whole shiftOf(const LightExtents& extents, const LightSlope& light, std::size_t slice) {
  return Whole(wholeShift(extents.depths[slice] / extents.texel, light, glm::dvec2(kHalfRounding)));
}

// Returns the light windows of a run in the order of slopesOf().
std::vector<LightWindow> windowsOf(const LightRun& run) {
  std::vector<LightWindow> windows;
  run.forEachWindow([&](const LightWindow& window) { windows.push_back(window); });
  return windows;
}

// Visits the texels (i, j), which cover [i, i + 1) x [j, j + 1), whose centre is in the rectangle.
template <class Visit>
void forEachTexel(const Rectangle& rectangle, const Visit& visit) {
  if (rectangle.empty()) return;
  for (auto y = static_cast<std::int64_t>(std::ceil(rectangle.min.y - 0.5)); y + 0.5 < rectangle.max.y; ++y)
    for (auto x = static_cast<std::int64_t>(std::ceil(rectangle.min.x - 0.5)); x + 0.5 < rectangle.max.x; ++x)
      visit(Whole(x, y));
}

// Light windows as textures that are addressed modulo their size. They are opened and stepped through as the shaders do
// it, but a path counts the slices that have touched it instead of what they leave of its light.
class Windows {
 public:
  Windows(std::size_t directions, const std::vector<LightRun>& runs) : open_(directions) {
    for (const LightRun& run : runs)
      for (const LightWindow& window : windowsOf(run)) size_ = glm::max(size_, Whole(window.size));
    texels_.assign(directions, std::vector<int>(static_cast<std::size_t>(size_.x * size_.y), -1));
  }
  void open(const LightRun& run) {
    const std::vector<LightWindow> windows = windowsOf(run);
    for (std::size_t k = 0; k < open_.size(); ++k) {
      const LightWindow window = windows[k], before = open_[k];
      for (int y = 0; y < window.size.y; ++y)
        for (int x = 0; x < window.size.x; ++x) {
          const Whole u = Whole(window.first) + Whole(x, y);
          if (!holds(before, u)) at(k, u) = 0;
        }
      open_[k] = window;
    }
  }
  bool has(std::size_t direction, const Whole& u) const { return holds(open_[direction], u); }
  int& at(std::size_t direction, const Whole& u) {
    const Whole place = ((u % size_) + size_) % size_;
    return texels_[direction][static_cast<std::size_t>(place.y * size_.x + place.x)];
  }

 private:
  static bool holds(const LightWindow& window, const Whole& u) {
    const Whole from = u - Whole(window.first);
    return from.x >= 0 && from.y >= 0 && from.x < window.size.x && from.y < window.size.y;
  }
  Whole size_{1};
  std::vector<LightWindow> open_;
  std::vector<std::vector<int>> texels_;
};

}  // namespace

TEST_CASE("Runs hold all slices that have something, in order, and are no longer and no larger than asked for",
          "[shade]") {
  TestRandom random(12);
  for (int round = 0; round < 200; ++round) {
    const LightExtents extents = randomExtents(random);
    const LightPaths paths = randomPaths(random);
    const LightPlanner planner(extents, paths);
    const auto count = static_cast<std::int64_t>(extents.depths.size());
    const std::int64_t first = random.below(static_cast<int>(count)),
                       last = first + random.below(static_cast<int>(count - first) + 1);
    const int longest = 1 + random.below(20);
    const double most = random.uniform(0, 2000);
    std::vector<std::int64_t> expected, found;
    for (std::int64_t i = first; i < last; ++i) {
      const auto slice = static_cast<std::size_t>(i);
      if (!extents.seen[slice].empty() || !extents.occluding[slice].empty()) expected.push_back(i);
    }
    INFO("round " << round);
    for (const LightRun& run : planner.runs(first, last, longest, most)) {
      REQUIRE_FALSE(run.slices.empty());
      REQUIRE(run.lights.size() == paths.lights.size());
      CHECK(run.slices.size() <= static_cast<std::size_t>(longest));
      if (run.slices.size() > 1)
        for (const LightWindow& window : windowsOf(run))
          CHECK(static_cast<double>(window.size.x) * window.size.y <= most);
      found.insert(found.end(), run.slices.begin(), run.slices.end());
    }
    CHECK(found == expected);
  }
}

// A pool of bricks may cut the sweeps, and so the runs, anywhere.
TEST_CASE("What is read from windows is what a sweep that keeps every path has", "[shade]") {
  TestRandom random(13);
  std::int64_t read = 0, shadowed = 0;
  for (int round = 0; round < 300; ++round) {
    const LightExtents extents = randomExtents(random);
    const LightPaths paths = randomPaths(random);
    const LightPlanner planner(extents, paths);
    const auto count = static_cast<std::int64_t>(extents.depths.size());
    std::vector<LightRun> runs;
    for (std::int64_t first = 0; first < count;) {
      const std::int64_t last = std::min<std::int64_t>(count, first + 1 + random.below(30));
      for (LightRun& run : planner.runs(first, last, 1 + random.below(12), random.uniform(0, 3000)))
        runs.push_back(std::move(run));
      first = last;
    }
    const std::vector<LightSlope> slopes = slopesOf(paths);
    Windows windows(slopes.size(), runs);
    std::vector<std::map<Texel, int>> touches(slopes.size());
    std::int64_t wrong = 0;
    for (const LightRun& run : runs) {
      windows.open(run);
      for (const std::int64_t i : run.slices) {
        const auto slice = static_cast<std::size_t>(i);
        for (std::size_t k = 0; k < slopes.size(); ++k) {
          const Whole shift = shiftOf(extents, slopes[k], slice);
          // What is seen is interpolated between texels, whose centres are up to one texel away.
          if (!extents.seen[slice].empty())
            forEachTexel(extents.seen[slice].grown(1), [&](const Whole& x) {
              const Whole u = x + shift;
              const auto touched = touches[k].find({u.x, u.y});
              const int expected = touched == touches[k].end() ? 0 : touched->second;
              wrong += (windows.has(k, u) ? windows.at(k, u) : 0) != expected;
              ++read;
              shadowed += expected > 0;
            });
          forEachTexel(extents.occluding[slice], [&](const Whole& x) {
            const Whole u = x + shift;
            ++touches[k][{u.x, u.y}];
            if (windows.has(k, u)) ++windows.at(k, u);
          });
        }
      }
    }
    INFO("round " << round);
    CHECK(wrong == 0);
  }
  CHECK(shadowed > read / 10);  // there is something to compare
  CHECK(shadowed < read);
}

// The paths that something has touched and that are still to be read lie within the width of what is on the slices,
// plus the way that they move during a run, however far they move in all.
TEST_CASE("A window is no wider than what is on the slices, however steep the light", "[shade]") {
  TestRandom random(14);
  for (const double towards : {0.9, 0.1, 1e-3, 1e-6, 1e-9, 1e-300}) {
    LightExtents extents;
    const double spacing = 0.5;
    extents.texel = 1;
    Rectangle all;
    for (int i = 0; i < 200; ++i) {
      extents.depths.push_back((i + 1000.5) * spacing);
      extents.occluding.push_back(randomRectangle(random, 30, 60));
      extents.seen.push_back(extents.occluding.back());
      all.include(extents.seen.back());
    }
    const LightSlope slope = lightSlope(glm::normalize(glm::dvec3(0.6, -0.8, towards)));
    LightPaths paths;
    paths.lights.push_back(slope);
    const LightPlanner planner(extents, paths);
    for (const int longest : {1, 5})
      for (const LightRun& run : planner.runs(0, 200, longest, 1e12)) {
        const glm::dvec2 moved =
            glm::abs(slope.slope) * spacing * static_cast<double>(run.slices.back() - run.slices.front());
        INFO("towards the viewer " << towards << ", slices " << run.slices.front() << " to " << run.slices.back());
        // There are two texels of border on each side, and sizes are rounded up to whole texels.
        const glm::dvec2 most = all.max - all.min + moved + 6.0;
        CHECK(run.lights[0].size.x <= most.x);
        CHECK(run.lights[0].size.y <= most.y);
        CHECK(run.lights[0].size.x > 0);
      }
  }
}

TEST_CASE("What nobody sees needs no windows, nor does what nothing can occlude", "[shade]") {
  LightExtents extents;
  LightPaths paths;
  paths.lights.push_back(lightSlope({0.6, 0, 0.8}));
  CHECK(LightPlanner(extents, paths).runs(0, 0, 4, 1e6).empty());
  CHECK(neededRegions(extents, paths).empty());
  for (int i = 0; i < 6; ++i) {
    extents.depths.push_back(i + 0.5);
    extents.occluding.push_back({});
    extents.seen.push_back({});
  }
  CHECK(LightPlanner(extents, paths).runs(0, 6, 4, 1e6).empty());
  extents.occluding[1] = {{0, 0}, {5, 5}};
  for (const Rectangle& needed : neededRegions(extents, paths)) CHECK(needed.empty());
  for (const LightRun& run : LightPlanner(extents, paths).runs(0, 6, 4, 1e6))
    for (const LightWindow& window : windowsOf(run)) CHECK(window.size == glm::ivec2(0));
  // Something is seen before anything occludes: all light arrives.
  extents.occluding[1] = {};
  extents.seen[0] = {{0, 0}, {5, 5}};
  extents.occluding[3] = {{0, 0}, {5, 5}};
  for (const LightRun& run : LightPlanner(extents, paths).runs(0, 6, 1, 1e6))
    for (const LightWindow& window : windowsOf(run)) CHECK(window.size == glm::ivec2(0));
}

TEST_CASE("A picture's runs lie within its sweeps, and one texture takes the windows of any", "[shade]") {
  TestRandom random(15);
  for (int round = 0; round < 100; ++round) {
    const LightExtents extents = randomExtents(random);
    const LightPlanner planner(extents, randomPaths(random));
    const auto count = static_cast<std::int64_t>(extents.depths.size());
    const std::int64_t cut = random.below(static_cast<int>(count) + 1);
    const std::vector<SweepRun> sweeps{{0, cut, {}}, {cut, count, {}}};
    // All slices of a run share 64 MiB: 8 of these, or one of those that take more than that.
    for (const auto& [bytes, longest] : {std::pair(double(8 << 20), 8), std::pair(1e9, 1), std::pair(1.0, 32)}) {
      const LightRuns plan = planLightRuns(planner, sweeps, bytes);
      CHECK(plan.slicesTogether == longest);
      std::size_t within = 0;
      for (const SweepRun& sweep : sweeps)
        for (const LightRun& run : plan.within(sweep.first, sweep.last)) {
          ++within;
          CHECK(run.slices.front() >= sweep.first);
          CHECK(run.slices.back() < sweep.last);
          CHECK(run.slices.size() <= static_cast<std::size_t>(longest));
          for (const LightWindow& window : windowsOf(run))
            CHECK(glm::max(window.size, plan.windowSize) == plan.windowSize);
        }
      CHECK(within == plan.runs.size());
    }
  }
}
