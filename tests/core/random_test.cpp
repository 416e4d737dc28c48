// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/random.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace umbrick;

// The demo of the reference implementation prints these numbers for seed 42 and stream 54 (pcg32-demo, O'Neill).
TEST_CASE("Random numbers are those of PCG", "[core]") {
  Random random(42, 54);
  for (const std::uint32_t expected : {0xa15c02b7u, 0x7b47f409u, 0xba1d3330u, 0x83d2f293u, 0xbfa4784bu, 0xcbed606eu})
    CHECK(random.next() == expected);
}

TEST_CASE("Uniform numbers have the mean and variance of the interval, and streams are uncorrelated", "[core]") {
  Random a(7, 1), b(7, 2);
  double sum = 0, squares = 0, product = 0;
  const int count = 100'000;
  for (int i = 0; i < count; ++i) {
    const double x = a.uniform() - 0.5, y = b.uniform() - 0.5;
    sum += x;
    squares += x * x;
    product += x * y;
  }
  // The limits are four standard deviations of each estimate.
  CHECK(std::abs(sum / count) < 4 * std::sqrt(1 / 12.0 / count));
  CHECK(std::abs(squares / count - 1 / 12.0) < 4 * std::sqrt(1 / 180.0 / count));
  CHECK(std::abs(product / count) < 4 * (1 / 12.0) / std::sqrt(count));
}
