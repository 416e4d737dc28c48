// Draws the part of one proxy slice that lies in one brick into both buffers at once (multiple render targets).
// Reads   atlas, transfer (see medium.glsl)   occlusion_prev (see footprint.glsl)
// Writes  eye        premultiplied RGBA, blended under: (ONE_MINUS_DST_ALPHA, ONE)
//         occlusion  blending off; pixels that no brick covers come from occlusion_spread.frag
//         aux        kAux: opacity-weighted visibility and depth, blended as eye
// Schott et al. 2009, doi:10.1111/j.1467-8659.2009.01464.x, section 4
// SPDX-License-Identifier: Apache-2.0
#include "shade/slab.glsl"
#include "shade/footprint.glsl"
flat in vec4 slab_centre;
layout(location = 0) out vec4 eye;
layout(location = 1) out float occlusion;
layout(location = 2) out vec4 aux;

void main() {
  Slab slab = evaluateSlab(slab_centre);
  vec2 uv = previousPoint();
  float seen = visibility(uv);
  eye = vec4(withEmission(slab.eye.rgb * seen, slab.emitted), slab.eye.a);
  occlusion = occlusionBehind(uv, slab.tau / rayStretch(screenPoint()), 2.0 * half_spacing);
  if (kAux != 0) aux = vec4(eye.a * seen, eye.a * slab_centre.w, 0.0, eye.a);
}
