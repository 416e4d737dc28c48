// How the light's directions look from the slices.
// SPDX-License-Identifier: Apache-2.0
#include "shade/light_aim.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <set>
#include <utility>

using namespace umbrick;

TEST_CASE("A slope is the step across per step towards the viewer", "[shade]") {
  const LightSlope straight = lightSlope({0, 0, 1});
  CHECK(straight.slope == glm::dvec2(0));
  CHECK(straight.stretch == 1);
  const LightSlope tilted = lightSlope({0.48, -0.64, 0.6});
  CHECK(tilted.slope.x == Approx(0.8));
  CHECK(tilted.slope.y == Approx(-0.64 / 0.6));
  CHECK(tilted.stretch == Approx(1 / 0.6));
}

TEST_CASE("Light is aimed in the axes of the view, and the view axis stands apart from its directions", "[shade]") {
  const CameraFrame axes{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};  // the viewer looks along +x
  const std::vector<LightDirection> directions{{{-1, 0, 0}, glm::dvec3(1)},
                                               {glm::normalize(glm::dvec3(-0.5, 0.7, -0.2)), glm::dvec3(3)}};
  const AimedLight aimed = aimLight(directions, axes);
  REQUIRE(aimed.paths.lights.size() == 2);
  CHECK(aimed.paths.count() == 3);
  CHECK(aimed.paths.view.slope == glm::dvec2(0));
  CHECK(aimed.paths.view.stretch == 1);
  CHECK(aimed.paths.lights[0].slope == glm::dvec2(0));  // light from the viewer
  CHECK(aimed.paths.lights[1].slope.x == Approx(1.4));
  CHECK(aimed.paths.lights[1].slope.y == Approx(-0.4));
  CHECK(aimed.whole == glm::dvec3(4));
  CHECK_FALSE(aimed.coloured);
  CHECK(aimed.radiance[0] == glm::vec4(1, 1, 1, 0.25f));
  CHECK(aimed.radiance[1] == glm::vec4(3, 3, 3, 0.75f));
}

TEST_CASE("Light is coloured where its directions differ in colour, not where all have the same one", "[shade]") {
  const CameraFrame axes{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  const glm::dvec3 orange(1, 0.6, 0.1);
  std::vector<LightDirection> directions{{{0, 0, 1}, 0.3 * orange}, {{0.6, 0, 0.8}, 1.7 * orange}};
  CHECK_FALSE(aimLight(directions, axes).coloured);
  directions[1].radiance.b += 0.01;
  CHECK(aimLight(directions, axes).coloured);
  directions = {{{0, 0, 1}, glm::dvec3(0)}};  // no light at all
  CHECK_FALSE(aimLight(directions, axes).coloured);
  CHECK(aimLight(directions, axes).radiance[0] == glm::vec4(0));
  CHECK(aimLight({}, axes).paths.count() == 1);
}

TEST_CASE("One half is the same rounding for all directions, other roundings differ from each other", "[shade]") {
  for (const glm::dvec2& same : shiftRoundings(5, glm::dvec2(0.5))) CHECK(same == glm::dvec2(kHalfRounding));
  std::set<std::pair<double, double>> found;
  for (const glm::dvec2& own : shiftRoundings(40, {0.3, 0.9})) {
    CHECK(own.x >= 0);
    CHECK(own.y >= 0);
    CHECK(own.x < 1);
    CHECK(own.y < 1);
    found.insert({own.x, own.y});
  }
  CHECK(found.size() == 40);
}

// At 45 degrees the middles of slabs that are as thick as a texel is wide shift by a half each.
TEST_CASE("A shift that ends in a half is rounded the same way on every slice", "[shade]") {
  const LightSlope light = lightSlope({std::numbers::sqrt2 / 2, -std::numbers::sqrt2 / 2, std::numbers::sqrt2 / 2});
  for (int slice = 0; slice < 10'000; ++slice) {
    const glm::dvec2 shift = wholeShift(slice + 0.5, light, glm::dvec2(kHalfRounding));
    REQUIRE(shift.x == slice);
    REQUIRE(shift.y == -slice - 1);
  }
}
