// What rays on OpenGL know of bricks without OpenGL: their order, their cells, their segments.
// SPDX-License-Identifier: Apache-2.0
#include "shade/brick_runs.h"

#include <catch2/catch.hpp>
#include <numeric>

#include "shade/ray_frame.h"
#include "shade/shade_fixture.h"
#include "support/test_grids.h"

using namespace umbrick;

namespace {

IndexView viewOf(const Camera& camera) { return indexView(camera, glm::dmat4(1)); }

}  // namespace

// A ray through the view meets bricks in order of their depth along it; where a run comes before another, no ray may
// meet a brick of the second before one of the first.
TEST_CASE("Runs of bricks are in the order in which every ray meets them", "[shade][rays]") {
  TestRandom random(4);
  const glm::ivec3 interior(8);
  for (int trial = 0; trial < 12; ++trial) {
    std::vector<glm::ivec3> origins;
    for (int z = -3; z < 3; ++z)
      for (int y = -2; y < 3; ++y)
        for (int x = -4; x < 2; ++x)
          if (random.uniform() < 0.4) origins.push_back(interior * glm::ivec3(x, y, z));
    const glm::dvec3 eye = random.point(glm::dvec3(-40), glm::dvec3(40));  // often among the bricks
    const Camera camera = trial % 2 ? perspectiveCamera(eye, random.point(glm::dvec3(-9), glm::dvec3(9)), 2, 32)
                                    : orthographicCamera(eye, random.point(glm::dvec3(-9), glm::dvec3(9)), 60, 32);
    const IndexView view = viewOf(camera);
    std::vector<int> runOf(origins.size(), -1);
    int runs = 0;
    const std::size_t most = 1 + static_cast<std::size_t>(random.below(9));
    BrickRuns(view, origins).draw([&](std::span<const std::int32_t> positions) {
      if (positions.size() > most) return false;
      for (const std::int32_t position : positions) {
        CHECK(runOf[static_cast<std::size_t>(position)] == -1);
        runOf[static_cast<std::size_t>(position)] = runs;
      }
      ++runs;
      return true;
    });
    CHECK(std::count(runOf.begin(), runOf.end(), -1) == 0);
    INFO("trial " << trial << ", " << runs << " runs");
    for (int y = 0; y < 32; y += 3)
      for (int x = 0; x < 32; x += 3) {
        const ViewRay ray = viewRay(camera, x + 0.5, y + 0.5);
        std::vector<std::pair<double, int>> met;  // where a ray enters a brick, and the run of it
        for (std::size_t i = 0; i < origins.size(); ++i) {
          const DepthInterval inside =
              keptDepths(ray, boxPlanes({glm::dvec3(origins[i]) - 0.5, glm::dvec3(origins[i] + interior) - 0.5}));
          if (inside.last > inside.first + 1e-9) met.emplace_back(inside.first, runOf[i]);
        }
        std::sort(met.begin(), met.end());
        CHECK(std::is_sorted(met.begin(), met.end(), [](const auto& a, const auto& b) { return a.second < b.second; }));
      }
  }
}

TEST_CASE("Segments of rays lie at the depths of slabs", "[shade][rays]") {
  const Camera camera = orthographicCamera({3, 4, 90}, {3, 4, 0}, 10, 8);
  const IndexView view = viewOf(camera);
  const std::vector<glm::ivec3> origins{{-8, 0, 16}, {8, -16, 0}};
  const CellBox cells = cellsAround(origins, glm::ivec3(8));
  CHECK(cells.first == glm::i64vec3(-8, -16, 0));
  CHECK(cells.count == glm::i64vec3(3, 3, 3));
  CHECK(cellsAround(origins, glm::ivec3(8), glm::ivec3(1, 2, 4)).count == glm::i64vec3(3, 6, 12));
  for (const double phase : {0.5, 0.2})
    for (const int segments : {1, 3}) {
      const RayFrame frame(view, cells, glm::ivec3(8), 1.5, segments, phase);
      CHECK(frame.depth == Approx(1.5 / segments));
      // The front of some segment is that of a slab: the middle of slab i is at (i + phase) times the spacing.
      const double front = frame.firstDepth - 0.5 * frame.depth;
      const double slabs = (front / 1.5 - phase + 0.5) * segments;
      CHECK(std::abs(slabs - std::round(slabs)) < 1e-9);
      // Bricks lie from depth 66.5 to 90.5, beyond which nothing is counted but a segment or two.
      CHECK(front <= 66.5);
      CHECK(front > 66.5 - 3 * frame.depth);
      CHECK(front + static_cast<double>(frame.count) * frame.depth >= 90.5);
      CHECK(front + static_cast<double>(frame.count) * frame.depth < 90.5 + 4 * frame.depth);
    }
  CHECK(RayFrame(viewOf(orthographicCamera({3, 4, -90}, {3, 4, -91}, 10, 8)), cells, glm::ivec3(8), 1, 1, 0.5).count ==
        0);  // all is behind the eye
}
