// First of two passes: draws the part of one proxy slice that lies in one brick, seen by the eye.
// Reads   atlas, transfer (see medium.glsl)   occlusion_prev (see footprint.glsl)
// Writes  eye  premultiplied RGBA, blended under: (ONE_MINUS_DST_ALPHA, ONE)
//         aux  kAux: opacity-weighted visibility and depth, blended alike
// Schott et al. 2009, doi:10.1111/j.1467-8659.2009.01464.x, Algorithm 1
// SPDX-License-Identifier: Apache-2.0
#include "shade/slab.glsl"
#include "shade/footprint.glsl"
flat in vec4 slab_centre;
layout(location = 0) out vec4 eye;
layout(location = 1) out vec4 aux;

void main() {
  Slab slab = evaluateSlab(slab_centre);
  float seen = visibility(previousPoint());
  eye = vec4(withEmission(slab.eye.rgb * seen, slab.emitted), slab.eye.a);
  if (kAux != 0) aux = vec4(eye.a * seen, eye.a * slab_centre.w, 0.0, eye.a);
}
