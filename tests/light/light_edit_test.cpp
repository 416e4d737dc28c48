// What an edit sweeps again: the same light as a fresh sweep, with less work.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "light/light_edit.h"
#include "light/lit_medium.h"
#include "support/field_bricks.h"
#include "support/test_scenes.h"
#include "umbrick/optics/directions.h"

using namespace umbrick;

namespace {

// Two layers of wavy medium, and a ball of larger values in a corner.
double field(const glm::ivec3& i) {
  const glm::dvec3 p(i);
  const double ball = std::max(0.0, 1 - glm::length(p - glm::dvec3(11, 12, 30)) / 7) * 2;
  const double layer = std::max(0.0, 0.5 - std::abs(p.z - 18 - 3 * std::sin(0.2 * p.x)) / 12);
  return p.x > 1 && p.x < 94 && p.y > 1 && p.y < 94 ? std::max(ball, layer) : 0;
}

TransferFunction function(double high, double first = 0.05, const glm::dvec3& albedo = glm::dvec3(1)) {
  return TransferFunction(
      {{first, {albedo, 0}}, {0.5, {albedo, 0.3}}, {0.6, {albedo, 0.3}}, {1.2, {albedo, high}}, {2, {albedo, 0.1}}});
}

std::vector<LightDirection> cone(int count, const glm::dvec3& axis = {0.1, 0.2, 1}) {
  std::vector<LightDirection> result;
  for (const WeightedDirection& one : spiralDirections(glm::normalize(axis), 40 * kDegree, count))
    result.push_back({one.direction, glm::dvec3(one.weight)});
  return result;
}

// Largest difference of the light of a medium from that of a fresh sweep, in steps of the codes of either. Both are
// rounded, and edits once more each.
double differenceFromFresh(const Bricks& volume, const LightVolume& light, const LightMedium& medium) {
  LightVolume fresh(volume);
  fresh.update(medium, kPlenty);
  REQUIRE_FALSE(fresh.stats().edited);
  REQUIRE(fresh.channels() == light.channels());
  const std::size_t numbers = volume.layout.voxels() * static_cast<std::size_t>(fresh.channels());
  std::vector<float> a(numbers), b(numbers);
  double worst = 0, most = 1;
  for (const glm::ivec3& cell : medium.cells) {
    light.read(cell, a);
    fresh.read(cell, b);
    for (std::size_t i = 0; i < numbers; ++i) {
      if ((a[i] == 0) != (b[i] == 0)) return 65535;  // known in one of them only
      most = std::max({most, double{a[i]}, double{b[i]}});
      worst = std::max(worst, std::abs(double{a[i]} - double{b[i]}));
    }
  }
  return worst / most * 65535;
}

const FieldBricks& volume() {
  static const FieldBricks bricks(field, {glm::ivec3(0), glm::ivec3(95, 95, 47)});
  return bricks;
}

constexpr double kStep = 1.01;

}  // namespace

TEST_CASE("An edit of the function in some bricks gives the light of a fresh sweep for less", "[light]") {
  const int spacing = GENERATE(1, 2);
  const glm::dvec3 axis =
      GENERATE(glm::dvec3(0.1, 0.2, 1), glm::dvec3(-1, 0.3, 0.1), glm::dvec3(0.2, 1, -0.3), glm::dvec3(0, 0.1, -1));
  INFO("spacing " << spacing << ", light from " << axis.x << ", " << axis.y << ", " << axis.z);
  LightVolume light(volume());
  LightMedium medium = mediumOf(volume(), function(2), cone(12, axis));
  medium.spacing = spacing;
  light.update(medium, kPlenty);
  CHECK_FALSE(light.stats().edited);
  const std::uint64_t all = light.stats().updates;
  medium.transfer = function(0.7);  // of values that the ball alone has
  REQUIRE(light.update(medium, kPlenty));
  CHECK(light.stats().edited);
  CHECK(light.stats().updates < 0.6 * all);
  CHECK(differenceFromFresh(volume(), light, medium) < kStep);
}

TEST_CASE("An edit of colours alone sweeps nothing", "[light]") {
  LightVolume light(volume());
  LightMedium medium = mediumOf(volume(), function(2), cone(12));
  light.update(medium, kPlenty);
  medium.transfer = function(2, 0.05, {0.2, 0.5, 0.9});
  light.update(medium, kPlenty);
  CHECK(light.stats().edited);
  CHECK(light.stats().updates == 0);
  CHECK(differenceFromFresh(volume(), light, medium) == 0);
}

TEST_CASE("A plane that cuts a corner, and its removal, give the light of a fresh sweep", "[light]") {
  LightVolume light(volume());
  LightMedium medium = mediumOf(volume(), function(2), cone(12));
  const LightMedium whole = medium;
  light.update(medium, kPlenty);
  const std::uint64_t all = light.stats().updates;
  const glm::dvec3 normal = glm::normalize(glm::dvec3(1, 0.7, 0.1));
  medium.planes.emplace_back(normal, -glm::dot(normal, glm::dvec3(8, 8, 20)));
  light.update(medium, kPlenty);
  CHECK(light.stats().edited);
  CHECK(light.stats().updates < all);
  CHECK(differenceFromFresh(volume(), light, medium) < 2 * kStep);
  light.update(whole, kPlenty);
  CHECK(light.stats().edited);
  CHECK(differenceFromFresh(volume(), light, whole) < 2 * kStep);
}

TEST_CASE("Bricks that come and go give the light of a fresh sweep", "[light]") {
  LightVolume light(volume());
  const LightMedium all = mediumOf(volume(), function(2), cone(8, {0, 0, 1}));
  LightMedium some = all;
  std::erase_if(some.cells, [](const glm::ivec3& cell) { return cell.x >= 80 && cell.y >= 80; });
  REQUIRE(some.cells.size() < all.cells.size());
  light.update(some, kPlenty);
  light.update(all, kPlenty);
  CHECK(light.stats().edited);
  CHECK(differenceFromFresh(volume(), light, all) < kStep);
  light.update(some, kPlenty);
  CHECK(light.stats().edited);
  CHECK(differenceFromFresh(volume(), light, some) < 2 * kStep);
}

TEST_CASE("Directions that stay are not swept again", "[light]") {
  LightVolume light(volume());
  std::vector<LightDirection> directions = cone(12);
  LightMedium medium = mediumOf(volume(), function(2), directions);
  light.update(medium, kPlenty);
  const std::uint64_t all = light.stats().updates;
  SECTION("one is added") {
    medium.directions.push_back({glm::normalize(glm::dvec3(1, 0.2, 0.3)), glm::dvec3(0.5)});
    light.update(medium, kPlenty);
    CHECK(light.stats().updates < 0.5 * all);
  }
  SECTION("one is taken away and one is brighter") {
    medium.directions.erase(medium.directions.begin() + 3);
    medium.directions[5].radiance *= 3.0;
    light.update(medium, kPlenty);
    CHECK(light.stats().updates < 0.5 * all);
  }
  SECTION("all are brighter") {
    for (LightDirection& one : medium.directions) one.radiance *= 2.5;
    light.update(medium, kPlenty);
    CHECK(light.stats().updates == 0);
  }
  CHECK(light.stats().edited);
  CHECK(light.stats().directions == static_cast<int>(medium.directions.size()));
  CHECK(differenceFromFresh(volume(), light, medium) < 2 * kStep);
}

TEST_CASE("An edit that touches most of the volume is a fresh sweep", "[light]") {
  LightVolume light(volume());
  LightMedium medium = mediumOf(volume(), function(2), cone(8));
  light.update(medium, kPlenty);
  medium = mediumOf(volume(), function(2, 0.1), cone(8));
  light.update(medium, kPlenty);
  CHECK_FALSE(light.stats().edited);
  CHECK(differenceFromFresh(volume(), light, medium) == 0);
}

TEST_CASE("After some edits all is swept again", "[light]") {
  LightVolume light(volume());
  LightMedium medium = mediumOf(volume(), function(2), cone(4, {0, 0, 1}));
  light.update(medium, kPlenty);
  int fresh = 0;
  for (int i = 0; i < 12; ++i) {
    medium.transfer = function(2 - 0.1 * i - 0.05);
    light.update(medium, kPlenty);
    fresh += !light.stats().edited;
  }
  CHECK(fresh == 1);
  CHECK(differenceFromFresh(volume(), light, medium) < 6 * kStep);
}

TEST_CASE("Functions are compared over the values of a brick alone", "[light]") {
  const auto brick = [](float low, float high) { return Brick{glm::ivec3(0), {low, high}, {}}; };
  const TransferFunction a = function(2), b = function(0.7);
  CHECK(sameExtinction(a, b, brick(0, 0.59f)));
  CHECK_FALSE(sameExtinction(a, b, brick(0, 0.7f)));
  CHECK_FALSE(sameExtinction(a, b, brick(1, 1.5f)));
  CHECK(sameExtinction(a, b, brick(2, 5)));
  CHECK_FALSE(sameExtinction(a, b, brick(0, 5)));
  // A peak between the ends of the range counts, and so does a step.
  const TransferFunction peak({{0, {glm::dvec3(1), 1}},
                               {1, {glm::dvec3(1), 1}},
                               {2, {glm::dvec3(1), 5}},
                               {3, {glm::dvec3(1), 1}},
                               {4, {glm::dvec3(1), 1}}}),
      flat({{0, {glm::dvec3(1), 1}}, {4, {glm::dvec3(1), 1}}});
  CHECK_FALSE(sameExtinction(peak, flat, brick(0.5f, 3.5f)));
  CHECK(sameExtinction(peak, flat, brick(3, 9)));
}

// What is read for one update is used for the next ones.
TEST_CASE("Directions, distances and functions that come and go give the light of a fresh sweep", "[light]") {
  LightVolume light(volume());
  const glm::dvec3 axes[]{{0.1, 0.2, 1}, {-1, 0.3, 0.1}, {0.2, 1, -0.3}};
  for (int i = 0; i < 9; ++i) {
    INFO("update " << i);
    LightMedium medium = mediumOf(volume(), function(i < 6 ? 2 : 0.7, i % 4 == 3 ? 0.3 : 0.05), cone(5, axes[i % 3]));
    medium.spacing = i == 4 || i == 5 ? 2 : 1;
    REQUIRE(light.update(medium, kPlenty));
    CHECK_FALSE(light.stats().edited);
    CHECK(differenceFromFresh(volume(), light, medium) == 0);
    LightVolume fresh(volume());
    fresh.update(medium, kPlenty);
    // A single picture holds no more than its light.
    CHECK((light.stats().heldBytes > fresh.stats().heldBytes) == (i > 0));
  }
}
