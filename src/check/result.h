// Combines measurements of several views into one result.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <string>

#include "umbrick/check/invariants.h"

namespace umbrick {

/// Returns how much of its limit a value takes; a value that is not a number takes more than all of it.
inline double shareOfLimit(double value, double limit) {
  if (value == 0) return 0;
  if (!(value <= limit)) return limit > 0 && value > limit ? value / limit : std::numeric_limits<double>::infinity();
  return value / limit;
}

/// Adds a measurement. The result keeps the one that is nearest to its limit, or farthest beyond it.
inline void addMeasurement(InvariantResult& result, double value, double limit, std::size_t samples,
                           const std::string& detail) {
  const bool first = result.samples == 0;
  if (first || shareOfLimit(value, limit) > shareOfLimit(result.value, result.limit)) {
    result.value = value;
    result.limit = limit;
    result.detail = detail;
  }
  result.samples += samples;
  result.passed = result.samples > 0 && result.value <= result.limit;
}

}  // namespace umbrick
