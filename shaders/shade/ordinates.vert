// Places a polygon of a proxy slice that looks up a layer of its own; otherwise the same as slice.vert.
// SPDX-License-Identifier: Apache-2.0
#include "shade/constants.glsl"
layout(location = kPositionAttribute) in vec2 position;
layout(location = kSlabAttribute) in vec4 slab;
layout(location = kLayerAttribute) in float layer;
flat out vec4 slab_centre;
flat out float slice_layer;

void main() {
  gl_Position = vec4(position, -0.6, 1.0);
  slab_centre = slab;
  slice_layer = layer;
}
