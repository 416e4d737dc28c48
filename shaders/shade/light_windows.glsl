// Transmittance windows, one layer per direction. On a slice at depth s, the path of direction k through lattice texel X
// is texel U = X + s slope_k of the plane of k, its shift rounded to whole texels, the same on every slice. A window is the
// part of that plane that is in use, stored modulo the size of the texture.
layout(binding = 0, r32f) coherent uniform image2DArray float_windows;
layout(binding = 0, r16) coherent uniform image2DArray fixed_windows;
uniform vec4 window[kDirections];  // xy: texels in use; zw: where the first of them is in the texture
uniform vec2 window_size;          // of the texture
uniform int first_direction;       // of all, the first of these

// u: counted from the first texel in use.
ivec3 windowTexel(vec2 u, int k) {
  vec2 texel = u + window[k].zw;
  return ivec3(ivec2(texel - window_size * vec2(greaterThanEqual(texel, window_size))), first_direction + k);
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
