// Light windows hold transmittance, one layer per path direction. On a slice at depth s, the path of direction k
// through lattice texel X is texel U = X + s slope_k of the plane of k, its shift rounded to whole texels, the same on
// every slice. A window is the part of that plane that is in use, stored modulo the texture's size (shaders/README.md).
// It is given by a vec4: xy the number of texels in use; zw where the first of them is in the texture.
// SPDX-License-Identifier: Apache-2.0
#include "shade/constants.glsl"
layout(binding = kWindowsImage, r32f) coherent uniform image2DArray float_windows;
layout(binding = kWindowsImage, r16) coherent uniform image2DArray fixed_windows;
uniform vec2 window_size;  // size of the texture, texels

// Tells whether a texel is in use. u is counted from the first texel in use.
bool isInWindow(vec2 u, vec4 window) {
  return all(greaterThanEqual(u, vec2(0.0))) && all(lessThan(u, window.xy));
}

ivec3 windowTexel(vec2 u, vec4 window, int layer) {
  vec2 texel = u + window.zw;
  return ivec3(ivec2(texel - window_size * vec2(greaterThanEqual(texel, window_size))), layer);
}

float loadWindow(ivec3 texel) {
  return kFixedPoint != 0 ? imageLoad(fixed_windows, texel).r : imageLoad(float_windows, texel).r;
}

void storeWindow(ivec3 texel, float transmittance) {
  if (kFixedPoint != 0)
    imageStore(fixed_windows, texel, vec4(transmittance));
  else
    imageStore(float_windows, texel, vec4(transmittance));
}
