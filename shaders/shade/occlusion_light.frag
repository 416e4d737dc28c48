// Second of two passes: draws the part of one proxy slice that lies in one brick, as it darkens what is behind it.
// Reads   atlas, transfer (see medium.glsl)   occlusion_prev (see footprint.glsl)
// Writes  occlusion  blending off; pixels that no brick covers come from occlusion_spread.frag
// Schott et al. 2009, doi:10.1111/j.1467-8659.2009.01464.x, Algorithm 1
// SPDX-License-Identifier: Apache-2.0
#include "shade/slab.glsl"
#include "shade/footprint.glsl"
flat in vec4 slab_centre;
layout(location = 0) out float occlusion;

void main() {
  Slab slab = evaluateSlab(slab_centre);
  occlusion = occlusionBehind(previousPoint(), slab.tau / rayStretch(screenPoint()), 2.0 * half_spacing);
}
