// The uniform cubic B-spline, by which gradients are smoothed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>

namespace umbrick {

/// Returns the weights of the coefficients at -1, 0, 1 and 2 at a place t in [0, 1]. Their sum is 1.
glm::vec4 bsplineWeights(float t);
/// Returns the same for the slope. Their sum is 0.
glm::vec4 bsplineSlopes(float t);

}  // namespace umbrick
