// Marks pixels through which next to nothing is seen, so that the depth test spares them all later slices.
// Reads   eye_so_far  premultiplied RGBA
// Writes  depth 0, by the vertices
// SPDX-License-Identifier: Apache-2.0
#include "shade/constants.glsl"
layout(binding = kEyeUnit) uniform sampler2D eye_so_far;
uniform float saturation;  // transmittance below which a pixel counts as saturated

void main() {
  if (1.0 - texelFetch(eye_so_far, ivec2(gl_FragCoord.xy), 0).a >= saturation) discard;
}
