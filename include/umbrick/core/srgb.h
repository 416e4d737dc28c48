// The sRGB transfer curve, IEC 61966-2-1: encoded display value in [0, 1] <-> linear light in [0, 1].
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

namespace umbrick {

inline double srgbToLinear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}
inline double linearToSrgb(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace umbrick
