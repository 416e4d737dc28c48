#include "umbrick/optics/medium.h"

#include <cmath>

namespace umbrick {
using std::cos, std::exp, std::sin, std::tan;
#include "optics/cone.glsl"
#include "optics/ramp.glsl"
#include "optics/slab.glsl"
}  // namespace umbrick
