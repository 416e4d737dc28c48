// SPDX-License-Identifier: Apache-2.0
#include "umbrick/optics/transfer_function.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "support/random_transfer.h"
#include "umbrick/core/error.h"

using namespace umbrick;

namespace {
constexpr glm::dvec3 kGrey{0.5};
const double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
}  // namespace

TEST_CASE("A transfer function is linear between points, and constant beyond them", "[optics]") {
  const TransferFunction f({{10, {{0, 0.2, 1}, 0}}, {20, {{1, 0.4, 0}, 4}}});
  CHECK(f(-5) == f(10));
  CHECK(f(99) == f(20));
  CHECK(f(12.5).sigma_t == Approx(1));
  CHECK(f(12.5).albedo.r == Approx(0.25));
  CHECK(f(15).sigma_s().g == Approx(0.3 * 2));
  CHECK(f(kNaN).sigma_t == 0);
}

TEST_CASE("Two equal values make a step that belongs to its upper side", "[optics]") {
  const TransferFunction f({{0, {kGrey, 1}}, {5, {kGrey, 1}}, {5, {kGrey, 3}}, {9, {kGrey, 3}}});
  CHECK(f(std::nextafter(5.0, 0.0)).sigma_t == 1);
  CHECK(f(5).sigma_t == 3);
  CHECK(f.majorant({0, std::nextafter(5.0f, 0.0f)}) == 1);
  CHECK(f.majorant({0, 5}) == 3);
  const TransferFunction threshold({{5, {kGrey, 0}}, {5, {kGrey, 2}}});
  CHECK(threshold(4.999).sigma_t == 0);
  CHECK(threshold(5).sigma_t == 2);
  // Of more than two equal values the ones in the middle have no place where they hold.
  CHECK(TransferFunction({{5, {kGrey, 0}}, {5, {kGrey, 7}}, {5, {kGrey, 2}}}) == threshold);
}

TEST_CASE("The falling side of a step counts in every range that comes from below", "[optics]") {
  const TransferFunction f({{0, {kGrey, 0}}, {5, {kGrey, 3}}, {5, {kGrey, 0}}});
  CHECK(f.majorant({0, 5}) == Approx(3));  // the supremum, which is never reached
  CHECK(f.isTransparent({5, 9}));
  CHECK_FALSE(f.isTransparent({std::nextafter(5.0f, 0.0f), 9}));
  CHECK(f.isTransparent({-kInfinity, 0}));
  CHECK(f.isTransparent(Range{}));  // nothing is there
}

// A fine scan takes the range and both sides of each control point: no value exceeds the majorant, and one reaches it.
TEST_CASE("The majorant bounds the function tightly over random ranges", "[optics]") {
  std::mt19937 random(3);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const TransferFunction f = randomTransferFunction(random, repeat % 4 == 0 ? 300 : repeat % 4 * 3);
    float low = uniform(random, -20, 120), high = uniform(random, -20, 120);
    if (low > high) std::swap(low, high);
    double largest = 0;
    const int steps = 4000;
    for (int i = 0; i <= steps; ++i)
      largest = std::max(largest, f(low + (static_cast<double>(high) - low) * i / steps).sigma_t);
    for (const double value : f.values())
      for (const double side : {std::nextafter(value, -1e9), value})
        if (side >= low && side <= high) largest = std::max(largest, f(side).sigma_t);
    const double majorant = f.majorant({low, high});
    CHECK(largest <= majorant * (1 + 1e-12));
    CHECK(largest >= majorant * (1 - 1e-9));  // the side of a step or steep peak is taken a rounding away from it
    CHECK(f.isTransparent({low, high}) == (majorant == 0));
  }
}

TEST_CASE("A 2D function is bilinear in value and gradient, and constant beyond its lattice", "[optics]") {
  // The value is fastest, so rows are gradients.
  const TransferFunction f({0, 10}, {0, 2}, {{kGrey, 0}, {kGrey, 1}, {kGrey, 2}, {kGrey, 5}});
  REQUIRE(f.is2d());
  CHECK(f(0, 0).sigma_t == 0);
  CHECK(f(10, 2).sigma_t == 5);
  CHECK(f(2.5, 0.5).sigma_t == Approx(0.75 * (0.25 * 1) + 0.25 * (2 + 0.25 * 3)));
  CHECK(f(-9, 99) == f(0, 2));
  CHECK(f.majorant({2.5f, 5}, {0, 1}) == Approx(f(5, 1).sigma_t));
  CHECK(f.isTransparent({-1, 0}, {-1, 0}));
  CHECK_FALSE(f.isTransparent({-1, 0}, {-1, 0.1f}));
}

TEST_CASE("A window stretches the domain and keeps the media", "[optics]") {
  const TransferFunction f({{0, {kGrey, 0}}, {0.25, {kGrey, 3}}, {1, {kGrey, 4}}});
  const TransferFunction windowed = f.windowed(-1000, 3000);
  CHECK(windowed.values() == std::vector<double>{-1000, 0, 3000});
  CHECK(windowed(0) == f(0.25));
  CHECK(windowed.valueDomain() == Range{-1000, 3000});
  CHECK(TransferFunction({{7, {kGrey, 0}}, {7, {kGrey, 1}}}).windowed(0, 10).values() == std::vector<double>{5, 5});
  CHECK_THROWS_WITH(f.windowed(3, 3), Catch::Contains("[3, 3]"));
  CHECK_THROWS_AS(f.windowed(0, kNaN), InvalidArgument);
}

TEST_CASE("Scaling multiplies sigma_t and leaves the albedo", "[optics]") {
  const TransferFunction f = TransferFunction({{0, {kGrey, 0.5}}, {1, {kGrey, 3}}}).scaled(2);
  CHECK(f(1).sigma_t == 6);
  CHECK(f(1).albedo == kGrey);
  CHECK_THROWS_AS(f.scaled(-1), InvalidArgument);
  CHECK_THROWS_AS(f.scaled(kNaN), InvalidArgument);
}

TEST_CASE("A domain is rounded outwards to float", "[optics]") {
  const Range domain = TransferFunction({{0.1, {kGrey, 0}}, {0.7, {kGrey, 1}}}).valueDomain();
  CHECK(static_cast<double>(domain.min) <= 0.1);
  CHECK(static_cast<double>(domain.max) >= 0.7);
  CHECK(domain.min == Approx(0.1).epsilon(2e-7));
}

TEST_CASE("Impossible transfer functions are refused, and the message names what is wrong", "[optics]") {
  using Points = std::vector<TransferFunction::Point>;
  CHECK_THROWS_WITH(TransferFunction(Points{}), Catch::Contains("no values"));
  CHECK_THROWS_WITH(TransferFunction(Points{{2, {}}, {1, {}}}), Catch::Contains("1 follows 2"));
  CHECK_THROWS_WITH(TransferFunction(Points{{kNaN, {}}}), Catch::Contains("not finite"));
  CHECK_THROWS_WITH(TransferFunction(Points{{0, {kGrey, -1}}}), Catch::Contains("sigma_t is -1"));
  CHECK_THROWS_WITH(TransferFunction(Points{{0, {{0, 1.5, 0}, 1}}}), Catch::Contains("albedo is 1.5"));
  CHECK_THROWS_WITH(TransferFunction({0, 1}, {0}, {Medium{}}), Catch::Contains("2 x 1 media, found 1"));
}
