// Draws the part of one proxy slice that lies in one brick: emission and absorption, every point lit alike.
// Reads   atlas, transfer (see medium.glsl)
// Writes  eye  premultiplied RGBA, blended under: (ONE_MINUS_DST_ALPHA, ONE)
//         aux  kAux: opacity-weighted visibility and depth, blended alike
// Max 1995, Optical models for direct volume rendering, doi:10.1109/2945.468400
// SPDX-License-Identifier: Apache-2.0
#include "shade/slab.glsl"
flat in vec4 slab_centre;
layout(location = 0) out vec4 eye;
layout(location = 1) out vec4 aux;

void main() {
  vec2 p = screenPoint();
  if (kStack == 2 && !liesInStack(p)) discard;
  Slab slab = evaluateSlab(slab_centre);
  eye = vec4(withEmission(slab.eye.rgb, slab.emitted), slab.eye.a);
  if (kAux != 0) aux = vec4(eye.a, eye.a * viewDepth(slab_centre, p), 0.0, eye.a);
}
