// SPDX-License-Identifier: Apache-2.0
#include "umbrick/optics/medium.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

using namespace umbrick;

// The promise is 1e-6 for x from 1e-8 to 1e4. Double precision is the truth, as its own error is a billion
// times smaller.
TEST_CASE("Opacity and slab factor do not cancel for thin or overflow for thick slabs", "[optics]") {
  double worst = 0;
  for (int i = 0; i <= 240'000; ++i) {
    const float x = static_cast<float>(std::pow(10.0, -8 + i * 5e-5));
    const double opacity = -std::expm1(-static_cast<double>(x));
    worst = std::max(worst, std::abs(oneMinusExp(x) / opacity - 1));
    worst = std::max(worst, std::abs(slabFactor(x) * static_cast<double>(x) / opacity - 1));
  }
  CHECK(worst < 1e-6);
  CHECK(oneMinusExp(0.0f) == 0.0f);
  CHECK(slabFactor(0.0f) == 1.0f);
  const float infinity = std::numeric_limits<float>::infinity();
  CHECK(oneMinusExp(infinity) == 1.0f);
  CHECK(slabFactor(infinity) == 0.0f);
  CHECK(slabFactor(std::numeric_limits<float>::denorm_min()) == 1.0f);
}

// The mean of x with the weight exp(-tau x) on [0, 1].
TEST_CASE("The place that is seen of a segment is the mean by what gets out of it", "[optics]") {
  double worst = 0;
  for (int i = 0; i <= 4000; ++i) {
    const float tau = static_cast<float>(std::pow(10.0, -1.5 + i * 1e-3));
    const double t = static_cast<double>(tau);
    worst = std::max(worst, std::abs(static_cast<double>(placeSeen(tau)) - (1 / t - 1 / std::expm1(t))));
  }
  CHECK(worst < 2e-6);
  CHECK(placeSeen(0.0f) == 0.5f);
}

TEST_CASE("Opacity rises with optical depth across the switch of formulas", "[optics]") {
  float x = 0.4999f;
  while (x < 0.5001f) {
    const float next = std::nextafter(x, 1.0f);
    // The limit is three roundings of numbers below 1 (6e-8 each at most): the exponential, the difference
    // and the series.
    REQUIRE(oneMinusExp(next) >= oneMinusExp(x) - 1.8e-7f);
    x = next;
  }
}

TEST_CASE("A slab cut in two scatters the same", "[optics]") {
  const float sigma_t = 1.7f, sigma_s = 1.1f, a = 0.4f, b = 1.3f;
  const auto scattered = [&](float ds) { return sigma_s * ds * slabFactor(sigma_t * ds); };
  CHECK(scattered(a) + (1 - oneMinusExp(sigma_t * a)) * scattered(b) == Approx(scattered(a + b)));
}
