// Spreads light from slice to slice, whether or not a brick is there.
// Reads   occlusion_prev (see footprint.glsl)
// Writes  occlusion  blending off
// SPDX-License-Identifier: Apache-2.0
#include "shade/footprint.glsl"
layout(location = 0) out float occlusion;

void main() { occlusion = meanOverFootprint(previousPoint()); }
