// The medium of a segment of a view ray: means of (sigma_s, sigma_t) between its front and its back, 1/world unit, associated
// colour.
//   kQuadrature 0  pre-integrated: the value runs linearly from front to back
//               1  the medium at the middle
//               2  the medium at the middle, by value and gradient magnitude
layout(binding = 0) uniform sampler3D atlas;      // r: value, g: gradient magnitude, in texel units
layout(binding = 1) uniform sampler2D transfer;   // 0: by (front, back); 1: by value, one row; 2: by (value, gradient)
uniform vec4 transfer_map;                        // to table coordinates: xy per texel unit, zw those of empty space
uniform vec2 empty_texel;                         // x: value of empty space, texel units; y: what rounding may add to it

// Distance from the value of empty space. That has a node of the table to itself, which may be all that is transparent
// of a medium that is solid elsewhere: it must be hit exactly.
float fromEmpty(float value) {
  float distance = value - empty_texel.x;
  return abs(distance) <= empty_texel.y ? 0.0 : distance;
}

// Table coordinate of the value at a point, which neighbouring pre-integrated segments share.
float endCoordinate(vec3 point) {
  return fromEmpty(textureLod(atlas, point, 0.0).r) * transfer_map.x + transfer_map.z;
}

vec4 rampMedium(float front, float back) { return textureLod(transfer, vec2(front, back), 0.0); }

vec4 pointMedium(vec3 point) {
  vec2 texel = textureLod(atlas, point, 0.0).rg;
  texel.r = fromEmpty(texel.r);
  if (kQuadrature == 1) texel.g = 0.0;
  return textureLod(transfer, texel * transfer_map.xy + transfer_map.zw, 0.0);
}
