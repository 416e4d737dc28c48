// Shows tests what a slice samples: the interpolated value at the slab's middle, and how often a pixel is hit.
// Reads   atlas
// Writes  probe  r: value in texel units, g: 1; blended additively
// SPDX-License-Identifier: Apache-2.0
#include "shade/ray.glsl"
#include "shade/constants.glsl"
layout(binding = kAtlasUnit) uniform sampler3D atlas;
flat in vec4 slab_centre;
layout(location = 0) out vec4 probe;

void main() { probe = vec4(textureLod(atlas, slabMiddle(slab_centre, screenPoint()), 0.0).r, 1.0, 0.0, 0.0); }
