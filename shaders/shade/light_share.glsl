// The light of a light volume, which lies beside the slots of the atlas: what share of all of it arrives at a point.
// SPDX-License-Identifier: Apache-2.0
#include "shade/constants.glsl"
layout(binding = kLightUnit) uniform sampler3D light;
layout(binding = kMoreLightUnit) uniform sampler3D more_light[kRayTextures - 1];
uniform vec3 whole_light;        // light that arrives where nothing is in the way

// Returns shares of whole_light, in rgb, and the one by power in a. @param point  in the atlas, [0, 1]
vec4 arrivingAt(vec3 point, int number) {
  vec4 texel = textureLod(light, point, 0.0);
  for (int i = 1; i < kTextures; ++i)
    if (number == i) texel = textureLod(more_light[i - 1], point, 0.0);
  return kColoured != 0 ? vec4(texel.rgb, dot(texel.rgb, whole_light) / dot(whole_light, vec3(1.0))) : texel.rrrr;
}
