// Opens some of the light windows for a run of slices: light is 1 on paths that were not in use before.
// Writes  windows  see light_windows.glsl
// SPDX-License-Identifier: Apache-2.0
#include "shade/light_windows.glsl"
layout(local_size_x = kLatticeTile, local_size_y = kLatticeTile) in;
uniform vec4 window[kWindows];         // see light_windows.glsl
uniform vec4 window_before[kWindows];  // texels in use until now, from xy to zw, counted as those of the window
uniform int first_layer;               // layer of the first of these windows

void main() {
  int i = int(gl_GlobalInvocationID.z);
  vec2 u = vec2(gl_GlobalInvocationID.xy);
  if (!isInWindow(u, window[i])) return;
  if (all(greaterThanEqual(u, window_before[i].xy)) && all(lessThan(u, window_before[i].zw))) return;
  storeWindow(windowTexel(u, window[i], first_layer + i), 1.0);
}
