// Reads the occlusion buffer of the slice before over the footprint of the cone.
// Schott et al. 2009, doi:10.1111/j.1467-8659.2009.01464.x, Eqs. 10-15, Algorithms 2 and 3.
// SPDX-License-Identifier: Apache-2.0
#include "optics/slab.glsl"
#include "shade/constants.glsl"
layout(binding = kOcclusionUnit) uniform sampler2D occlusion_prev;  // 1 = unoccluded
uniform vec2 texel_size;         // pixels to occlusion_prev's coordinates
uniform float previous_scale;    // size of this slice over that of the one before, from the view axis (Eqs. 12-15)
uniform vec2 view_axis;          // where the view axis crosses the image, in occlusion_prev's coordinates
uniform vec4 taps[kTaps];        // xy: displacement in occlusion_prev's coordinates; z: length of the way to it (world)

// Returns where the point straight before the fragment, along the slice normal, lies in the slice before.
vec2 previousPoint() { return view_axis + (gl_FragCoord.xy * texel_size - view_axis) * previous_scale; }

float visibility(vec2 uv) { return textureLod(occlusion_prev, uv, 0.0).r; }

// Returns the mean over the footprint, which is what leaves an empty slab.
float meanOverFootprint(vec2 uv) {
  float sum = 0.0;
  for (int i = 0; i < kTaps; ++i) sum += visibility(uv + taps[i].xy);
  return sum * (1.0 / float(kTaps));
}

// Returns what leaves a slab of thickness `spacing` and of optical depth tau along the slice normal.
float occlusionBehind(vec2 uv, float tau, float spacing) {
  if (kAlgorithm == 3) return meanOverFootprint(uv) * exp(-tau);
  float sum = 0.0;
  for (int i = 0; i < kTaps; ++i) sum += visibility(uv + taps[i].xy) * exp(-tau * (taps[i].z / spacing));
  return sum * (1.0 / float(kTaps));
}
