// How far apart two pictures of one size are.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstddef>

#include "umbrick/image/image.h"

namespace umbrick {

/// Returns the root mean square over those of all numbers of the pictures that `counts(i)` tells; 0 where none does.
template <class Counts>
double rmsDifference(const Image& a, const Image& b, const Counts& counts) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    if (!counts(i)) continue;
    sum += std::pow(static_cast<double>(a.pixels[i]) - static_cast<double>(b.pixels[i]), 2);
    ++count;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}
inline double rmsDifference(const Image& a, const Image& b) {
  return rmsDifference(a, b, [](std::size_t) { return true; });
}
/// Leaves out the opacity of pictures of four channels.
inline double rmsOfColour(const Image& a, const Image& b) {
  return rmsDifference(a, b, [](std::size_t i) { return i % 4 != 3; });
}

}  // namespace umbrick
