// Draws the part of one proxy slice that lies in one brick into both buffers at once (multiple render targets), over
// light that has been spread already.
// Reads   atlas, transfer (see medium.glsl)   occlusion_prev (see footprint.glsl)
// Writes  eye        premultiplied RGBA, blended under: (ONE_MINUS_DST_ALPHA, ONE)
//         occlusion  blended by multiplication (ZERO, SRC_COLOR) with the mean that occlusion_spread.frag has left
//         aux        kAux: opacity-weighted visibility and depth, blended as eye
// Schott et al. 2009, doi:10.1111/j.1467-8659.2009.01464.x, section 4, Algorithm 3
// SPDX-License-Identifier: Apache-2.0
#include "shade/slab.glsl"
#include "shade/footprint.glsl"
flat in vec4 slab_centre;
layout(location = 0) out vec4 eye;
layout(location = 1) out float occlusion;
layout(location = 2) out vec4 aux;

void main() {
  Slab slab = evaluateSlab(slab_centre);
  float seen = visibility(previousPoint());
  eye = vec4(withEmission(slab.eye.rgb * seen, slab.emitted), slab.eye.a);
  occlusion = exp(-slab.tau / rayStretch(screenPoint()));
  if (kAux != 0) aux = vec4(eye.a * seen, eye.a * slab_centre.w, 0.0, eye.a);
}
