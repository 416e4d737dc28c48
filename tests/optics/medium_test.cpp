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

TEST_CASE("Transmittance is multiplicative along a segment", "[optics]") {
  const float sigma_t = 0.3f;  // 1/world unit
  CHECK(transmittance(sigma_t, 5.5f) == Approx(transmittance(sigma_t, 1.5f) * transmittance(sigma_t, 4.0f)));
}

TEST_CASE("A slab cut in two scatters the same", "[optics]") {
  const float sigma_t = 1.7f, sigma_s = 1.1f, a = 0.4f, b = 1.3f;
  const auto scattered = [&](float ds) { return sigma_s * ds * slabFactor(sigma_t * ds); };
  CHECK(scattered(a) + transmittance(sigma_t, a) * scattered(b) == Approx(scattered(a + b)));
}

// A phase function is a density over directions.
TEST_CASE("Cone phase integrates to one over the sphere", "[optics]") {
  for (const float aperture : {0.05f, 0.7f, 1.5f}) {
    const int steps = 2'000'000;  // midpoints in cos(angle); the edge of the cone is off by one step at most
    double integral = 0;
    for (int i = 0; i < steps; ++i) {
      const double cosAngle = -1 + 2 * (i + 0.5) / steps;
      integral += 2 * std::numbers::pi * 2 / steps * conePhase(static_cast<float>(cosAngle), aperture);
    }
    // The error is the one step, and the rounding of float near cos = 1, where numbers are 6e-8 apart.
    const double share = 1 - std::cos(static_cast<double>(aperture));
    CHECK(integral == Approx(1).margin((2.0 / steps + 1.2e-7) / share));
  }
}

TEST_CASE("A narrow cone keeps its solid angle", "[optics]") {
  // The solid angle is pi a^2 to second order; 1 - cos(1e-4) in float would be 0 or 1.2 times it.
  CHECK(coneSolidAngle(1e-4f) == Approx(3.14159265 * 1e-8).epsilon(1e-6));
  CHECK(coneSolidAngle(1.57079633f) == Approx(2 * 3.14159265).epsilon(1e-6));
  CHECK(coneRadius(2.0f, 0.7853982f) == Approx(2).epsilon(1e-6));
}
