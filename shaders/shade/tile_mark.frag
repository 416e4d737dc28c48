// Sets the depth that decides what is drawn until the next look: bricks are drawn at 1/5, carried light at 1/2.
// Reads   state  by tile, see tile_state.frag
// Writes  depth  0: nothing; 1/4: only bricks, there is no occlusion to carry; 1: everything
// SPDX-License-Identifier: Apache-2.0
#include "shade/constants.glsl"
layout(binding = kTileStateUnit) uniform sampler2D tile_state;

void main() {
  vec2 state = texelFetch(tile_state, ivec2(gl_FragCoord.xy) / kTileEdge, 0).rg;
  gl_FragDepth = state.r == 0.0 ? 0.0 : state.g == 0.0 ? 0.25 : 1.0;
}
