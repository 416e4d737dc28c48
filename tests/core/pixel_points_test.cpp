// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/pixel_points.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>
#include <set>

#include "support/coverage.h"
#include "support/observed_order.h"
#include "umbrick/core/error.h"
#include "umbrick/core/random.h"

using namespace umbrick;

TEST_CASE("One point of a pixel is its centre, to the last bit", "[core]") {
  CHECK(pixelPoints(1) == std::vector<glm::dvec2>{{0.5, 0.5}});
}

TEST_CASE("Each row and each column of a pixel has one point in its middle", "[core]") {
  for (const int count : {2, 3, 4, 5, 7, 16, 21, 100, 1000}) {
    INFO(count << " points");
    const std::vector<glm::dvec2> points = pixelPoints(count);
    REQUIRE(points.size() == static_cast<std::size_t>(count));
    std::set<int> columns, rows;
    glm::dvec2 sum(0);
    for (const glm::dvec2& point : points) {
      sum += point;
      for (const int axis : {0, 1}) {
        const double cell = point[axis] * count - 0.5;
        CHECK(cell == Approx(std::round(cell)).margin(1e-9));
        (axis == 0 ? columns : rows).insert(static_cast<int>(std::lround(cell)));
      }
    }
    CHECK(columns.size() == points.size());
    CHECK(rows.size() == points.size());
    CHECK(*columns.begin() == 0);
    CHECK(*rows.rbegin() == count - 1);
    // So the mean of what is linear over the pixel is exact.
    CHECK(sum.x / count == Approx(0.5).margin(1e-12));
    CHECK(sum.y / count == Approx(0.5).margin(1e-12));
  }
}

// The error of the area on one side of a line. For lines of any direction no set of points does better than the power
// 3/4 of their number (Beck 1987); random points reach 1/2.
TEST_CASE("The share of points beside a line tends to the area beside it, with an order near 3/4", "[core]") {
  std::vector<double> counts, errors;
  for (const int count : {4, 16, 64, 256, 1024}) {
    const std::vector<glm::dvec2> points = pixelPoints(count);
    Random random(5);
    double square = 0;
    constexpr int kLines = 2000;
    for (int i = 0; i < kLines; ++i) {
      const double angle = 2 * std::numbers::pi * random.uniform();
      HalfPlane half{{std::cos(angle), std::sin(angle)}, 0};
      half.offset = -half.at({random.uniform(), random.uniform()});
      double inside = 0;
      for (const glm::dvec2& point : points) inside += half.at(point) >= 0;
      square += std::pow(inside / count - coverage(half, 0, 0), 2);
    }
    counts.push_back(count);
    errors.push_back(std::sqrt(square / kLines));
    CAPTURE(count, errors.back());
    CHECK(errors.back() < 0.35 * std::pow(count, -0.7));
  }
  const double order = observedOrder(counts, errors);
  INFO("order " << order);
  CHECK(order < -0.7);
}

TEST_CASE("A pixel needs a point", "[core]") {
  CHECK_THROWS_AS(pixelPoints(0), InvalidArgument);
  CHECK_THROWS_AS(pixelPoints(-3), InvalidArgument);
}

TEST_CASE("Each part of the time of a moving camera is seen once, whatever the place in the pixel", "[core]") {
  for (const int count : {1, 2, 7, 16, 100}) {
    std::vector<double> times = pixelTimes(count), sorted = times;
    std::sort(sorted.begin(), sorted.end());
    for (int i = 0; i < count; ++i) CHECK(sorted[static_cast<std::size_t>(i)] == Approx((i + 0.5) / count));
    if (count < 16) continue;
    // The correlation of times and places is 1 where they go together.
    const std::vector<glm::dvec2> points = pixelPoints(count);
    glm::dvec2 together(0);
    for (int i = 0; i < count; ++i)
      together += (points[static_cast<std::size_t>(i)] - 0.5) * (times[static_cast<std::size_t>(i)] - 0.5);
    together *= 12.0 / count;
    CAPTURE(count, together.x, together.y);
    CHECK(std::abs(together.x) < 0.2);
    CHECK(std::abs(together.y) < 0.2);
  }
  CHECK_THROWS_AS(pixelTimes(0), InvalidArgument);
}
