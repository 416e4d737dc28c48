// SPDX-License-Identifier: Apache-2.0
#include "umbrick/optics/directions.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "umbrick/core/error.h"

using namespace umbrick;

namespace {}

TEST_CASE("Gauss-Legendre integrates polynomials of degree 2n - 1 exactly", "[optics]") {
  for (const int n : {1, 2, 3, 5, 16, 64}) {
    const std::vector<QuadratureNode> nodes = gaussLegendre(n);
    for (int degree = 0; degree <= 2 * n - 1; ++degree) {
      double sum = 0;
      for (const QuadratureNode& node : nodes) sum += node.weight * std::pow(node.position, degree);
      CHECK(sum == Approx(1.0 / (degree + 1)).epsilon(1e-13));
    }
  }
}

TEST_CASE("Directions of a cone lie in it, share it and balance around its axis", "[optics]") {
  for (const double aperture : {0.1, 1.0, 1.5, std::numbers::pi / 2, std::numbers::pi})
    for (const int count : {1, 3, 4, 8, 32, 500}) {
      const glm::dvec3 axis = glm::normalize(glm::dvec3(0.3, -0.7, 0.2));
      for (const bool spiral : {false, true}) {
        double sum = 0, along = 0;
        const auto directions =
            spiral ? spiralDirections(axis, aperture, count, 0.4) : coneDirections(axis, aperture, count, 0.4);
        CHECK(std::abs(static_cast<int>(directions.size()) - count) <= (spiral ? 0 : 1 + count / 10));
        for (const auto& [direction, weight] : directions) {
          CHECK(glm::length(direction) == Approx(1).epsilon(1e-14));
          CHECK(glm::dot(direction, axis) >= std::cos(aperture) - 1e-14);
          sum += weight;
          along += weight * glm::dot(direction, axis);
        }
        CHECK(sum == Approx(1).epsilon(1e-13));
        // The mean cosine over the solid angle is (1 + cos aperture) / 2. Any number of rings is exact for it, and so
        // is a spiral, whose cosines are the middles of equal steps.
        if (count > 1) CHECK(along == Approx((1 + std::cos(aperture)) / 2).margin(1e-13));
      }
    }
}

// The integrand is smooth on the cone: what a homogeneous medium of unit depth does to light, exp(-1 / cos). By
// substitution the closed form is an exponential integral; 64 Gauss nodes in the cosine have it to rounding.
TEST_CASE("The mean over a cone converges faster than any power of the rings", "[optics][slow]") {
  const double aperture = 1.0, cosine = std::cos(aperture);
  double exact = 0;
  for (const auto& [position, weight] : gaussLegendre(64))
    exact += weight * std::exp(-1 / (1 - position * (1 - cosine)));
  double before = 1;
  for (const int count : {4, 16, 64, 256}) {
    double sum = 0;
    for (const auto& [direction, weight] : coneDirections({0, 0, 1}, aperture, count))
      sum += weight * std::exp(-1 / direction.z);
    const double error = std::abs(sum - exact);
    CHECK(error < std::max(before / 4, 1e-15));  // a set whose error were of order one in the rings would give a half
    before = error;
  }
}

TEST_CASE("Random directions of a cone are uniform in its solid angle", "[optics]") {
  // A lattice of the unit square is mapped to directions, whose mean cosine is known.
  const double aperture = 1.2;
  double along = 0;
  for (int i = 0; i < 64; ++i)
    for (int j = 0; j < 64; ++j) along += sampleCone({0, 1, 0}, aperture, (i + 0.5) / 64, (j + 0.5) / 64).y / 4096;
  CHECK(along == Approx((1 + std::cos(aperture)) / 2).epsilon(1e-12));
}

TEST_CASE("An axis of no length, an aperture out of range and a count of 0 are refused", "[optics]") {
  CHECK_THROWS_AS(coneDirections({0, 0, 0}, 1, 4), InvalidArgument);
  CHECK_THROWS_AS(coneDirections({0, 0, 1}, -1, 4), InvalidArgument);
  CHECK_THROWS_AS(coneDirections({0, 0, 1}, 1, 0), InvalidArgument);
  CHECK_THROWS_AS(gaussLegendre(0), InvalidArgument);
}
