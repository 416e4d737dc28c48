// Places a polygon of a proxy slice in a target with one layer per slice; otherwise the same as slice.vert.
// SPDX-License-Identifier: Apache-2.0
#extension GL_ARB_shader_viewport_layer_array : require
#include "shade/constants.glsl"
layout(location = kPositionAttribute) in vec2 position;
layout(location = kSlabAttribute) in vec4 slab;
layout(location = kLayerAttribute) in float layer;
flat out vec4 slab_centre;

void main() {
  gl_Position = vec4(position, -0.6, 1.0);
  gl_Layer = int(layer);
  slab_centre = slab;
}
