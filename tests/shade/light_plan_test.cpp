// What the light's windows hold, against a sweep that keeps every path for ever.
#include "shade/light_plan.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <utility>

#include "support/test_grids.h"

using namespace umbrick;

namespace {

using Texel = std::pair<std::int64_t, std::int64_t>;
using Whole = glm::vec<2, std::int64_t>;

Rectangle randomRectangle(TestRandom& random, double extent, double most) {
  const glm::dvec2 low(random.uniform(-extent, extent), random.uniform(-extent, extent));
  return {low, low + glm::dvec2(random.uniform(0.1, most), random.uniform(0.1, most))};
}

LightExtents randomExtents(TestRandom& random) {
  LightExtents extents;
  const double spacing = random.uniform(0.1, 3);
  extents.texel = random.uniform(0.2, 2);
  const int count = 1 + random.below(40);
  const int first = random.below(100);
  for (int i = 0; i < count; ++i) {
    extents.depths.push_back((first + i + 0.5) * spacing);
    const bool gap = random.uniform() < 0.2;
    extents.occluding.push_back(gap || random.uniform() < 0.1 ? Rectangle{} : randomRectangle(random, 8, 9));
    extents.seen.push_back(gap || random.uniform() < 0.3 ? Rectangle{} : randomRectangle(random, 8, 9));
  }
  return extents;
}

std::vector<LightSlope> randomSlopes(TestRandom& random) {
  std::vector<LightSlope> slopes;
  const int count = 1 + random.below(4);
  for (int k = 0; k < count; ++k)
    slopes.push_back(lightSlope(glm::normalize(
        glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform() < 0.2 ? 0.003 : random.uniform()))));
  slopes.push_back(lightSlope({0, 0, 1}));
  return slopes;
}

// As the renderer rounds it.
Whole shiftOf(const LightExtents& extents, const LightSlope& light, std::size_t slice) {
  return Whole(glm::floor(extents.depths[slice] / extents.texel * light.slope + 0.5 - 1e-6));
}

// Texels (i, j) that cover [i, i + 1) x [j, j + 1) and have their centre in the rectangle.
template <class Visit>
void forEachTexel(const Rectangle& rectangle, const Visit& visit) {
  if (rectangle.empty()) return;
  for (auto y = static_cast<std::int64_t>(std::ceil(rectangle.min.y - 0.5)); y + 0.5 < rectangle.max.y; ++y)
    for (auto x = static_cast<std::int64_t>(std::ceil(rectangle.min.x - 0.5)); x + 0.5 < rectangle.max.x; ++x)
      visit(Whole(x, y));
}

// The windows as textures that are addressed modulo their size, opened and stepped through as the shaders do; a path
// counts the slices that have touched it instead of what they leave of its light.
class Windows {
 public:
  Windows(std::size_t directions, const std::vector<LightRun>& runs) : open_(directions) {
    for (const LightRun& run : runs)
      for (const LightWindow& window : run.windows) size_ = glm::max(size_, Whole(window.size));
    texels_.assign(directions, std::vector<int>(static_cast<std::size_t>(size_.x * size_.y), -1));
  }
  void open(const LightRun& run) {
    for (std::size_t k = 0; k < open_.size(); ++k) {
      const LightWindow window = run.windows[k], before = open_[k];
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

TEST_CASE("A slope is the step across per step towards the viewer", "[shade]") {
  const LightSlope straight = lightSlope({0, 0, 1});
  CHECK(straight.slope == glm::dvec2(0));
  CHECK(straight.stretch == 1);
  const LightSlope tilted = lightSlope({0.48, -0.64, 0.6});
  CHECK(tilted.slope.x == Approx(0.8));
  CHECK(tilted.slope.y == Approx(-0.64 / 0.6));
  CHECK(tilted.stretch == Approx(1 / 0.6));
}

TEST_CASE("Rectangles are empty, joined, cut, grown and moved as sets of points", "[shade]") {
  const Rectangle none, a{{0, 0}, {2, 3}}, b{{1, -1}, {4, 1}};
  CHECK(none.empty());
  CHECK(none.grown(5).empty());
  CHECK(none.moved({1, 2}).empty());
  CHECK(none.within(a).empty());
  Rectangle joined = none;
  joined.include(none);
  CHECK(joined.empty());
  joined.include(a);
  joined.include(b);
  CHECK(joined.min == glm::dvec2(0, -1));
  CHECK(joined.max == glm::dvec2(4, 3));
  CHECK(a.within(b).min == glm::dvec2(1, 0));
  CHECK(a.within(b).max == glm::dvec2(2, 1));
  CHECK(a.within(Rectangle{{3, 0}, {4, 1}}).empty());
  CHECK(a.grown(0.5).min == glm::dvec2(-0.5));
  CHECK(a.moved({1, -1}).max == glm::dvec2(3, 2));
}

TEST_CASE("The needed region of a slice holds every path to what is seen behind it, and no more", "[shade]") {
  TestRandom random(11);
  for (int round = 0; round < 100; ++round) {
    const LightExtents extents = randomExtents(random);
    const std::vector<LightSlope> slopes = randomSlopes(random);
    const std::vector<Rectangle> needed = neededRegions(extents, slopes);
    REQUIRE(needed.size() == extents.depths.size());
    for (std::size_t j = 0; j < needed.size(); ++j) {
      Rectangle hull;
      for (const LightSlope& light : slopes)
        for (std::size_t i = j; i < needed.size(); ++i)
          hull.include(extents.seen[i].moved((extents.depths[i] - extents.depths[j]) / extents.texel * light.slope));
      INFO("round " << round << ", slice " << j);
      REQUIRE(needed[j].empty() == hull.empty());
      if (hull.empty()) continue;
      // Sums of steep slopes, some 1e5 texels, in double precision.
      CHECK(glm::length(needed[j].min - hull.min) < 1e-9);
      CHECK(glm::length(needed[j].max - hull.max) < 1e-9);
    }
  }
}

TEST_CASE("Runs hold all slices that have something, in order, and are no longer and no larger than asked for",
          "[shade]") {
  TestRandom random(12);
  for (int round = 0; round < 200; ++round) {
    const LightExtents extents = randomExtents(random);
    const std::vector<LightSlope> slopes = randomSlopes(random);
    const LightPlanner planner(extents, slopes);
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
      REQUIRE(run.windows.size() == slopes.size());
      CHECK(run.slices.size() <= static_cast<std::size_t>(longest));
      if (run.slices.size() > 1)
        for (const LightWindow& window : run.windows) CHECK(static_cast<double>(window.size.x) * window.size.y <= most);
      found.insert(found.end(), run.slices.begin(), run.slices.end());
    }
    CHECK(found == expected);
  }
}

// Sweeps of a pool cut runs anywhere.
TEST_CASE("What is read from windows is what a sweep that keeps every path has", "[shade]") {
  TestRandom random(13);
  std::int64_t read = 0, shadowed = 0;
  for (int round = 0; round < 300; ++round) {
    const LightExtents extents = randomExtents(random);
    const std::vector<LightSlope> slopes = randomSlopes(random);
    const LightPlanner planner(extents, slopes);
    const auto count = static_cast<std::int64_t>(extents.depths.size());
    std::vector<LightRun> runs;
    for (std::int64_t first = 0; first < count;) {
      const std::int64_t last = std::min<std::int64_t>(count, first + 1 + random.below(30));
      for (LightRun& run : planner.runs(first, last, 1 + random.below(12), random.uniform(0, 3000)))
        runs.push_back(std::move(run));
      first = last;
    }
    Windows windows(slopes.size(), runs);
    std::vector<std::map<Texel, int>> paths(slopes.size());
    std::int64_t wrong = 0;
    for (const LightRun& run : runs) {
      windows.open(run);
      for (const std::int64_t i : run.slices) {
        const auto slice = static_cast<std::size_t>(i);
        for (std::size_t k = 0; k < slopes.size(); ++k) {
          const Whole shift = shiftOf(extents, slopes[k], slice);
          // What is seen is interpolated between texels: centres up to one away.
          if (!extents.seen[slice].empty())
            forEachTexel(extents.seen[slice].grown(1), [&](const Whole& x) {
              const Whole u = x + shift;
              const auto touched = paths[k].find({u.x, u.y});
              const int expected = touched == paths[k].end() ? 0 : touched->second;
              wrong += (windows.has(k, u) ? windows.at(k, u) : 0) != expected;
              ++read;
              shadowed += expected > 0;
            });
          forEachTexel(extents.occluding[slice], [&](const Whole& x) {
            const Whole u = x + shift;
            ++paths[k][{u.x, u.y}];
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

// Paths that something has touched and that are still to be read lie within the width of what is on the slices, plus
// what they move during a run, however far they move in all.
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
    const LightPlanner planner(extents, std::vector<LightSlope>{slope});
    for (const int longest : {1, 5})
      for (const LightRun& run : planner.runs(0, 200, longest, 1e12)) {
        const glm::dvec2 moved =
            glm::abs(slope.slope) * spacing * static_cast<double>(run.slices.back() - run.slices.front());
        INFO("towards the viewer " << towards << ", slices " << run.slices.front() << " to " << run.slices.back());
        // Two texels of border on each side, and rounding up to whole ones.
        const glm::dvec2 most = all.max - all.min + moved + 6.0;
        CHECK(run.windows[0].size.x <= most.x);
        CHECK(run.windows[0].size.y <= most.y);
        CHECK(run.windows[0].size.x > 0);
      }
  }
}

TEST_CASE("What nobody sees needs no windows, nor does what nothing can occlude", "[shade]") {
  LightExtents extents;
  const std::vector<LightSlope> slopes{lightSlope({0, 0, 1}), lightSlope({0.6, 0, 0.8})};
  CHECK(LightPlanner(extents, slopes).runs(0, 0, 4, 1e6).empty());
  CHECK(neededRegions(extents, slopes).empty());
  for (int i = 0; i < 6; ++i) {
    extents.depths.push_back(i + 0.5);
    extents.occluding.push_back({});
    extents.seen.push_back({});
  }
  CHECK(LightPlanner(extents, slopes).runs(0, 6, 4, 1e6).empty());
  extents.occluding[1] = {{0, 0}, {5, 5}};
  for (const Rectangle& needed : neededRegions(extents, slopes)) CHECK(needed.empty());
  for (const LightRun& run : LightPlanner(extents, slopes).runs(0, 6, 4, 1e6))
    for (const LightWindow& window : run.windows) CHECK(window.size == glm::ivec2(0));
  // Seen before anything occludes: all light arrives.
  extents.occluding[1] = {};
  extents.seen[0] = {{0, 0}, {5, 5}};
  extents.occluding[3] = {{0, 0}, {5, 5}};
  for (const LightRun& run : LightPlanner(extents, slopes).runs(0, 6, 1, 1e6))
    for (const LightWindow& window : run.windows) CHECK(window.size == glm::ivec2(0));
}
