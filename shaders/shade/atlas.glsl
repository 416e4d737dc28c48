// The voxels of bricks.
// SPDX-License-Identifier: Apache-2.0
#include "shade/constants.glsl"
layout(binding = kAtlasUnit) uniform sampler3D atlas;  // r: value, g: gradient magnitude, b: value of a second grid, in texel units
