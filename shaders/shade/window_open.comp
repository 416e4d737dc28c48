// Opens the windows for a run of slices: paths that were not in use before are clear.
// Writes  windows  see light_windows.glsl
#include "shade/light_windows.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
uniform vec4 window_before[kDirections];  // texels in use until now, from xy to zw, counted as those of the window

void main() {
  int k = int(gl_GlobalInvocationID.z);
  vec2 u = vec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(u, window[k].xy))) return;
  if (all(greaterThanEqual(u, window_before[k].xy)) && all(lessThan(u, window_before[k].zw))) return;
  storeWindow(windowTexel(u, k), 1.0);
}
