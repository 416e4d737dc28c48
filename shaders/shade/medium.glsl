// The medium of a slab: means of (sigma_s, sigma_t) between its front and its back, 1/world unit, associated colour.
//   kQuadrature 0  pre-integrated: the value runs linearly from front to back
//               1  the medium at the middle
//               2  the medium at the middle, by value and gradient magnitude
layout(binding = 0) uniform sampler3D atlas;      // r: value, g: gradient magnitude, in texel units
layout(binding = 1) uniform sampler2D transfer;   // 0: by (front, back); 1: by value, one row; 2: by (value, gradient)
uniform vec4 transfer_map;                        // texel units to table coordinates: xy scale, zw offset

vec4 slabMedium(vec3 front, vec3 back) {
  if (kQuadrature == 0) {
    vec2 values = vec2(textureLod(atlas, front, 0.0).r, textureLod(atlas, back, 0.0).r);
    return textureLod(transfer, values * transfer_map.x + transfer_map.z, 0.0);
  }
  vec2 texel = textureLod(atlas, 0.5 * (front + back), 0.0).rg;
  if (kQuadrature == 1) texel.g = 0.0;
  return textureLod(transfer, texel * transfer_map.xy + transfer_map.zw, 0.0);
}
