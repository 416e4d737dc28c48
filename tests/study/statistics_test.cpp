// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/statistics.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "support/complaint.h"
#include "umbrick/core/error.h"
#include "umbrick/core/random.h"

using namespace umbrick;

TEST_CASE("The spread of values is that of their order statistics", "[report]") {
  CHECK(spreadOf({5, 1, 4, 2, 3}) == Spread{1, 2, 3, 4, 5});
  CHECK(spreadOf({4, 1, 3, 2}) == Spread{1, 1.75, 2.5, 3.25, 4});
  CHECK(spreadOf({7}) == Spread{7, 7, 7, 7, 7});
  // The median ignores one slow frame of seven.
  CHECK(spreadOf({2, 2, 2, 2, 2, 2, 1000}).median == 2);
  CHECK(complaint<InvalidArgument>([] { spreadOf({}); }) == "spread: no values");
}

TEST_CASE("Ratios are those of values at the same place", "[report]") {
  CHECK(ratios(std::vector<double>{6, 10}, std::vector<double>{2, 4}) == std::vector<double>{3, 2.5});
  CHECK(complaint<InvalidArgument>([] { ratios(std::vector<double>{1}, {}); }) == "ratios: 1 values over 0");
}

namespace {
// Tells by the definition, point by point, whether a point is dominated.
bool isDominated(const std::vector<CostAndError>& points, std::size_t i) {
  return std::any_of(points.begin(), points.end(), [&](const CostAndError& other) {
    return other.cost <= points[i].cost && other.error <= points[i].error &&
           (other.cost < points[i].cost || other.error < points[i].error);
  });
}
}  // namespace

TEST_CASE("Nothing dominates a member of the Pareto front, and something dominates every other point", "[report]") {
  Random random(3);
  for (int round = 0; round < 200; ++round) {
    std::vector<CostAndError> points(static_cast<std::size_t>(1 + round % 40));
    // Points lie on a coarse lattice in every other round, so that many are equal in one coordinate or in both.
    const double steps = round % 2 == 0 ? 5 : 1e9;
    for (CostAndError& point : points)
      point = {std::floor(random.uniform() * steps), std::floor(random.uniform() * steps)};
    const std::vector<std::size_t> front = paretoFront(points);
    REQUIRE(!front.empty());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool member = std::find(front.begin(), front.end(), i) != front.end();
      CHECK(member != isDominated(points, i));
    }
    CHECK(std::is_sorted(front.begin(), front.end(),
                         [&](std::size_t a, std::size_t b) { return points[a].cost < points[b].cost; }));
  }
}

TEST_CASE("What is not finite is on no Pareto front", "[report]") {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
  CHECK(paretoFront(std::vector<CostAndError>{{1, infinity}, {2, 1}, {nan, 0}, {0.5, nan}}) ==
        std::vector<std::size_t>{1});
  CHECK(paretoFront(std::vector<CostAndError>{}).empty());
}

TEST_CASE("The order of c x^p is p", "[report]") {
  const std::vector<double> h{0.25, 0.5, 1, 3, 8};
  for (const double p : {0.5, 1.0, 2.0, 4.0}) {
    std::vector<double> error;
    for (const double x : h) error.push_back(0.037 * std::pow(x, p));
    // Five logarithms are rounded.
    CHECK(orderOfConvergence(h, error).value() == Approx(p).epsilon(1e-12));
  }
}

TEST_CASE("The order of noisy errors is the least-squares slope", "[report]") {
  // Logarithms of h are -1, 0, 1 and of the error a - 1, b, c + 1: the slope is 1 + (c - a) / 2, whatever b is.
  const double e = std::exp(1.0), a = 0.1, b = 0.7, c = -0.2;
  const std::vector<double> h{1 / e, 1, e}, error{std::exp(a - 1), std::exp(b), std::exp(c + 1)};
  CHECK(orderOfConvergence(h, error).value() == Approx(1 + (c - a) / 2).epsilon(1e-12));
}

TEST_CASE("There is no order without two distances, or with an error of 0", "[report]") {
  const std::vector<double> two{1, 2}, same{0.3, 0.3, 0.3}, errors{0.5, 0.6, 0.8};
  CHECK(!orderOfConvergence(std::vector<double>{1}, std::vector<double>{1}));
  CHECK(!orderOfConvergence({}, {}));
  CHECK(!orderOfConvergence(same, errors));
  CHECK(!orderOfConvergence(two, std::vector<double>{1, 0}));
}
