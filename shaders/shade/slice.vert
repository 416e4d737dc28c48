// Places a polygon of a proxy slice, whose vertices are in device coordinates already.
// Reads   position  normalised device coordinates
//         slab      xyz: atlas coordinates of the slice plane at the centre of the image, for the polygon's brick;
//                   w: depth of the slice's middle, world units
// SPDX-License-Identifier: Apache-2.0
#include "shade/constants.glsl"
layout(location = kPositionAttribute) in vec2 position;
layout(location = kSlabAttribute) in vec4 slab;
flat out vec4 slab_centre;

void main() {
  gl_Position = vec4(position, -0.6, 1.0);  // depth 1/5, see tile_mark.frag
  slab_centre = slab;
}
