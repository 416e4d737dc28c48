// The numbers that shaders of this room and C++ share; they stand in shaders/shade/constants.glsl.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace umbrick {
#include "shade/constants.glsl"
}  // namespace umbrick
