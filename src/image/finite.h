// Radiance as pictures show it: what is no number counts as nothing.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>

namespace umbrick {

/// Returns 0 for NaN, and for what is below 0; infinity becomes a number that is brighter than any display.
inline double finiteOr0(float value) { return std::isnan(value) ? 0 : std::clamp<double>(value, 0, 1e30); }

}  // namespace umbrick
