// SPDX-License-Identifier: Apache-2.0
#include "shade/footprint.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

using namespace umbrick;

TEST_CASE("Footprint samples are point-symmetric in the unit disk", "[shade]") {
  for (int n = 1; n <= 16; ++n) {
    INFO("n " << n);
    const std::vector<glm::dvec2> points = diskGrid(n);
    REQUIRE(points.size() == static_cast<std::size_t>(n * n));
    glm::dvec2 mean(0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      mean += points[i] / static_cast<double>(points.size());
      CHECK(glm::length(points[i]) <= 1);
      CHECK(glm::distance(points[i], -points[points.size() - 1 - i]) < 1e-12);
    }
    CHECK(glm::length(mean) < 1e-12);
  }
  CHECK(diskGrid(1).front() == glm::dvec2(0));
}

// A disk of radius 1 has the variance 1/4 along an axis. For an even n, ring k of n/2 holds 4 (2 k - 1) of the cells at
// radius (2 k - 1) / n. The sum of the cubes of odd numbers, n^2/8 (n^2 - 2), then leaves 1/4 - 1/(2 n^2).
TEST_CASE("The variance of the footprint tends to a disk's", "[shade]") {
  for (const int n : {2, 4, 8, 16}) {
    glm::dvec2 variance(0);
    for (const glm::dvec2& p : diskGrid(n)) variance += p * p / static_cast<double>(n * n);
    CHECK(variance.x == Approx(0.25 - 0.5 / (n * n)).epsilon(1e-12));
    CHECK(variance.y == Approx(0.25 - 0.5 / (n * n)).epsilon(1e-12));
  }
}

// The map keeps areas: each of four rings of equal area, and each of eight sectors, holds its share of many points.
TEST_CASE("Footprint samples are spread with equal areas", "[shade]") {
  const int n = 64;
  int rings[4] = {}, sectors[8] = {};
  for (const glm::dvec2& p : diskGrid(n)) {
    ++rings[std::min(3, static_cast<int>(4 * glm::dot(p, p)))];
    ++sectors[static_cast<int>(std::floor((std::atan2(p.y, p.x) + 3.14159265358979) / 0.785398163397449)) % 8];
  }
  // Points on a border, a row of n of them, count on one side.
  for (const int count : rings) CHECK(std::abs(count - n * n / 4) <= 4 * n);
  for (const int count : sectors) CHECK(std::abs(count - n * n / 8) <= n);
}
