// Finds what the occlusion sweep still has to do in each tile of the image.
// Reads   eye_so_far      premultiplied RGBA
//         occlusion_prev  1 = unoccluded
//         covered_by      RG32F, by tile: first and last slice with a brick there
// Writes  state  by tile; r: 1 where a pixel's colour can still change, g: 1 where light is, or soon will be, occluded
// SPDX-License-Identifier: Apache-2.0
#include "shade/constants.glsl"
layout(binding = kEyeUnit) uniform sampler2D eye_so_far;
layout(binding = kCoveredByUnit) uniform sampler2D covered_by;
layout(binding = kOcclusionUnit) uniform sampler2D occlusion_prev;
uniform float saturation;   // transmittance below which a pixel counts as saturated
uniform float slice;        // the slice that is drawn next
uniform float next_look;    // the slice at which the state is found anew
uniform float imperceptible;  // occlusion less than this counts as none
layout(location = 0) out vec2 state;

void main() {
  ivec2 tile = ivec2(gl_FragCoord.xy), last = textureSize(eye_so_far, 0) - 1;
  vec2 covered = texelFetch(covered_by, tile, 0).rg;
  bool visible = false, dark = covered.r < next_look;
  for (int y = 0; y < kTileEdge; ++y)
    for (int x = 0; x < kTileEdge; ++x) {
      ivec2 pixel = min(tile * kTileEdge + ivec2(x, y), last);
      if (covered.g >= slice) visible = visible || 1.0 - texelFetch(eye_so_far, pixel, 0).a >= saturation;
      if (!dark) dark = dark || 1.0 - texelFetch(occlusion_prev, pixel, 0).r > imperceptible;
    }
  state = vec2(visible ? 1.0 : 0.0, dark ? 1.0 : 0.0);
}
