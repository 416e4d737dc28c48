// A closed interval of values, empty until something is included.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <limits>

namespace umbrick {

struct Range {
  float min = std::numeric_limits<float>::infinity();
  float max = -std::numeric_limits<float>::infinity();

  bool empty() const { return !(min <= max); }
  bool contains(float value) const { return min <= value && value <= max; }
  float extent() const { return empty() ? 0.0f : max - min; }
  void include(float value) {
    min = std::min(min, value);
    max = std::max(max, value);
  }
  void include(const Range& other) {
    min = std::min(min, other.min);
    max = std::max(max, other.max);
  }
  bool operator==(const Range&) const = default;
};

}  // namespace umbrick
