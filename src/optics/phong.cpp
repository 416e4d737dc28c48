// SPDX-License-Identifier: Apache-2.0
#include "umbrick/optics/phong.h"

#include <algorithm>
#include <cmath>

namespace umbrick {
using std::max, std::pow;
#include "optics/phong.glsl"
}  // namespace umbrick
