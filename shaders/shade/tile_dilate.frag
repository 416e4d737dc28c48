// Spreads the state of tiles along one axis: a tile that light can reach counts like the one where light is.
// Reads   state_before  by tile, see tile_state.frag
// Writes  state         by tile
// SPDX-License-Identifier: Apache-2.0
#include "shade/constants.glsl"
layout(binding = kTileStateUnit) uniform sampler2D state_before;
uniform vec2 reach;    // of each channel, tiles
uniform vec2 scale;    // how distances from the view axis change on the way, from 1 to this
uniform vec2 centre;   // where the view axis crosses the image, tiles
uniform vec2 axis;     // (1, 0) or (0, 1)
layout(location = 0) out vec2 state;

void main() {
  ivec2 count = textureSize(state_before, 0), along = ivec2(axis);
  ivec2 tile = ivec2(gl_FragCoord.xy) * (1 - along);
  float here = dot(gl_FragCoord.xy, axis), middle = dot(centre, axis);
  for (int channel = 0; channel < 2; ++channel) {
    float there = middle + (here - middle) * scale[channel];
    int from = max(int(floor(min(here, there) - reach[channel])), 0);
    int to = min(int(floor(max(here, there) + reach[channel])), count.x * along.x + count.y * along.y - 1);
    float found = 0.0;
    for (int i = from; i <= to; ++i) found = max(found, texelFetch(state_before, tile + i * along, 0)[channel]);
    state[channel] = found;
  }
}
