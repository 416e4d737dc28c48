// SPDX-License-Identifier: Apache-2.0
#include "umbrick/optics/bspline.h"

namespace umbrick {
using glm::vec4;
#include "optics/bspline.glsl"
}  // namespace umbrick
