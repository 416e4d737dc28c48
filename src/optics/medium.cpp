// SPDX-License-Identifier: Apache-2.0
#include "umbrick/optics/medium.h"

#include <algorithm>
#include <cmath>

namespace umbrick {
using std::cos, std::exp, std::log, std::max, std::sin, std::sqrt, std::tan;
#include "optics/cone.glsl"
#include "optics/ramp.glsl"
#include "optics/slab.glsl"
}  // namespace umbrick
