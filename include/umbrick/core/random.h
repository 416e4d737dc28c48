// Seeded random numbers that do not depend on who draws first.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec2.hpp>

namespace umbrick {

/// The steps of the low-discrepancy sequence R2 in the unit square, whose point i is fract(start + i step). They are
/// 1/g and 1/g^2, with g^3 = g + 1. Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences".
inline const glm::dvec2 kR2Step(0.7548776662466927, 0.5698402909980532);

/// The generator PCG XSH-RR 64/32: each seed has 2^63 independent streams. O'Neill 2014, HMC-CS-2014-0905.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0) : increment_(2 * stream + 1) {
    next();
    state_ += seed;
    next();
  }

  std::uint32_t next() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005u + increment_;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
    const auto turns = static_cast<std::uint32_t>(old >> 59);
    return (shifted >> turns) | (shifted << ((32 - turns) & 31));
  }
  /// Returns a number in (0, 1). It is never 0, so that its logarithm is finite.
  double uniform() { return (next() + 0.5) * 0x1p-32; }

 private:
  std::uint64_t state_ = 0, increment_;
};

}  // namespace umbrick
