// SPDX-License-Identifier: Apache-2.0
#include "umbrick/optics/transfer_stretches.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "support/random_transfer.h"
#include "umbrick/optics/medium.h"
#include "umbrick/optics/transfer_function.h"

using namespace umbrick;

TEST_CASE("Stretches join without gaps, and steps have none", "[optics]") {
  const std::vector<AxisStretch> stretches = axisStretches({1, 2, 2, 5});
  REQUIRE(stretches.size() == 4);
  CHECK(std::isinf(stretches.front().lower));
  CHECK(std::isinf(stretches.back().upper));
  for (std::size_t i = 1; i < stretches.size(); ++i) CHECK(stretches[i].lower == stretches[i - 1].upper);
  // The stretches are: below 1; from 1 to the lower side of the step; from its upper side to 5; above.
  const std::pair<std::size_t, std::size_t> points[]{{0, 0}, {0, 1}, {2, 3}, {3, 3}};
  for (std::size_t i = 0; i < 4; ++i) CHECK(std::pair(stretches[i].low, stretches[i].high) == points[i]);
  CHECK(axisStretches({3}).size() == 2);
  CHECK(axisStretches({3, 3}).size() == 2);
}

// A shader does the same: it takes the stretch whose number is the count of ends at or below the value,
// and interpolates.
TEST_CASE("Interpolation within stretches is the function, at steps its upper side", "[optics]") {
  std::mt19937 random(5);
  for (int trial = 0; trial < 200; ++trial) {
    const TransferFunction transfer = randomTransferFunction(random, 2 + trial % 9);
    const std::vector<AxisStretch> stretches = axisStretches(transfer.values());
    std::vector<double> values = transfer.values();
    for (int i = 0; i < 20; ++i)
      values.push_back(transfer.values().front() +
                       (1.4 * uniform(random, 0, 1) - 0.2) * (transfer.values().back() - transfer.values().front()));
    for (const double value : values) {
      const auto number = static_cast<std::size_t>(
          std::count_if(stretches.begin(), stretches.end(), [&](const AxisStretch& s) { return s.upper <= value; }));
      const AxisStretch& stretch = stretches[number];
      const Medium &low = transfer.media()[stretch.low], &high = transfer.media()[stretch.high];
      const double place = stretch.low == stretch.high ? 0 : (value - stretch.lower) / (stretch.upper - stretch.lower);
      CHECK(low.sigma_t + place * (high.sigma_t - low.sigma_t) == Approx(transfer(value).sigma_t).margin(1e-12));
    }
  }
}

// The truth is a sum over 20 000 parts.
TEST_CASE("Light of a piece comes from where its centroid says", "[optics]") {
  const auto largestError = [](double mostTau) {
    double largest = 0;
    for (double front = 0; front <= 1; front += 0.125)
      for (double tau = 0.01; tau <= mostTau; tau *= 1.7) {
        const double back = 1 - front;
        double sum = 0, first = 0;
        for (int i = 0; i < 20'000; ++i) {
          const double x = (i + 0.5) / 20'000, sigma = front + (back - front) * x;
          const double weight = sigma * std::exp(-tau * x * (2 * front + (back - front) * x));
          sum += weight;
          first += weight * x;
        }
        const float found = scatteringCentroid(static_cast<float>(front), static_cast<float>(back),
                                               static_cast<float>(tau), oneMinusExp(static_cast<float>(tau)));
        largest = std::max(largest, std::abs(found - first / sum));
      }
    return largest;
  };
  // This is the error that the header states.
  CHECK(largestError(1e4) < 0.009);
  // If nothing scatters, or next to nothing, the centroid is in the middle.
  CHECK(scatteringCentroid(0, 0, 0, 0) == Approx(0.5));
  CHECK(scatteringCentroid(1e-12f, 1e-12f, 1e-12f, 1e-12f) == Approx(0.5));
  // With extinction as large as a renderer's bound, it is at the very front.
  CHECK(scatteringCentroid(1e30f, 1e30f, 1e30f, 1) == Approx(0).margin(1e-6));
}
