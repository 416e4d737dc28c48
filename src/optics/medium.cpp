// SPDX-License-Identifier: Apache-2.0
#include "umbrick/optics/medium.h"

#include <algorithm>
#include <cmath>

namespace umbrick {
using std::exp, std::log, std::max, std::sqrt;
#include "optics/ramp.glsl"
#include "optics/slab.glsl"
}  // namespace umbrick
