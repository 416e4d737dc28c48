// Draws the part of one proxy slice that lies in one brick, lit by what the light windows let through.
// Reads   atlas, transfer (see medium.glsl)   visibility, visibility_weight (see window_step.comp)
// Writes  eye  premultiplied RGBA, blended under: (ONE_MINUS_DST_ALPHA, ONE)
//         aux  kAux: opacity-weighted visibility and depth, blended alike
// SPDX-License-Identifier: Apache-2.0
#include "shade/slab.glsl"
#include "shade/constants.glsl"
layout(binding = kVisibilityUnit) uniform sampler2DArray visibility;
layout(binding = kVisibilityWeightUnit) uniform sampler2DArray visibility_weight;
uniform vec4 lattice_map;  // view coordinates across to visibility's coordinates: xy scale, zw offset
uniform vec3 whole_light;  // light that arrives where nothing is in the way
uniform float brightest;   // light of this radiance is 1 in the eye buffer
flat in vec4 slab_centre;
flat in float slice_layer;
layout(location = 0) out vec4 eye;
layout(location = 1) out vec4 aux;

// Returns the share of a slab's scattering that its own medium lets through: light that has come through d / cos and
// goes d_e to the eye, integrated over a slab of optical depth tau towards the eye, over the same without occlusion.
// path: length of the light's path over that of the eye's.
float selfShadow(float tau, float path) {
  return slabFactor(tau * (1.0 + path)) / slabFactor(tau);
}

void main() {
  Slab slab = evaluateSlab(slab_centre);
  vec2 p = screenPoint();
  vec2 across = kPerspective != 0 ? slab_centre.w * p : p;
  vec3 place = vec3(across * lattice_map.xy + lattice_map.zw, slice_layer);
  vec4 light = textureLod(visibility, place, 0.0) / textureLod(visibility_weight, place, 0.0).r;
  float share = kColoured != 0 ? dot(light.rgb, vec3(1.0)) / dot(whole_light, vec3(1.0)) : light.r;
  float weighted = kColoured != 0 ? light.a : light.g;
  float stretch = rayStretch(p);
  float path = weighted > 0.0 ? (share / weighted - 1.0) / stretch : 1.0;
  float self = selfShadow(slab.tau, path);
  vec3 scattered = slab.eye.rgb * self * (kColoured != 0 ? light.rgb : share * whole_light) / brightest;
  eye = vec4(withEmission(scattered, slab.emitted), slab.eye.a);
  if (kAux != 0) aux = vec4(eye.a * self * share, eye.a * slab_centre.w, 0.0, eye.a);
}
