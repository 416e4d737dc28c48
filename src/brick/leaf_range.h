// The range of a leaf's values.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>

#include "brick/tree_walk.h"
#include "umbrick/core/range.h"

namespace umbrick {

/// @param values  all values of a leaf, which must be finite
inline Range rangeOfLeaf(const float* values) {
  // The lanes are independent, so that the compiler may use vectors. It must not reorder a single running
  // minimum of floats.
  constexpr int lanes = 8;
  std::array<float, lanes> low, high;
  std::copy_n(values, lanes, low.begin());
  std::copy_n(values, lanes, high.begin());
  for (int i = lanes; i < static_cast<int>(FloatLeaf::SIZE); i += lanes)
    for (int lane = 0; lane < lanes; ++lane) {
      const float value = values[i + lane];
      low[lane] = value < low[lane] ? value : low[lane];
      high[lane] = value > high[lane] ? value : high[lane];
    }
  return {*std::min_element(low.begin(), low.end()), *std::max_element(high.begin(), high.end())};
}

}  // namespace umbrick
