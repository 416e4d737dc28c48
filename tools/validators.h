// Checks values of options: finite numbers, with messages that say what was expected.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <string>

#include "command_line.h"

namespace umbrick::tools {

/// Accepts a number that is finite, which CLI11's own ranges do not ask for, and that `accept` agrees to.
/// @param expected  completes "expected ..., found -1"; also shown in the help
template <typename Accept>
CLI::Validator finiteNumber(Accept accept, const std::string& expected) {
  return CLI::Validator(
      [accept, expected](const std::string& text) {
        double value = 0;
        const bool good = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && accept(value);
        return good ? std::string() : "expected " + expected + ", found " + text;
      },
      "(" + expected + ")");
}
inline CLI::Validator finiteNumber() {
  return finiteNumber([](double) { return true; }, "a number");
}
inline CLI::Validator nonNegativeNumber() {
  return finiteNumber([](double value) { return value >= 0; }, "a number >= 0");
}
inline CLI::Validator positiveNumber() {
  return finiteNumber([](double value) { return value > 0; }, "a number > 0");
}
/// Accepts a number between two ends. @param range  as messages print it, for example "0 to 1"
inline CLI::Validator numberIn(double low, double high, const std::string& range) {
  return finiteNumber([low, high](double value) { return value >= low && value <= high; }, "a number from " + range);
}
/// Accepts the name of a type of voxels.
inline CLI::Validator voxelType() {
  return CLI::IsMember({"u8", "i8", "u16", "i16", "u32", "i32", "i64", "u64", "f16", "f32", "f64"});
}

}  // namespace umbrick::tools
