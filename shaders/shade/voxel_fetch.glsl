// Single voxels of bricks, and the values between them, as exact as texels hold them: filters of textures round, on some
// hardware to 1/256 of what lies between two voxels.
// SPDX-License-Identifier: Apache-2.0
#include "shade/atlas.glsl"
layout(binding = kMoreAtlasUnit) uniform sampler3D more_atlas[kRayTextures - 1];
uniform float code_scale;   // kFixedPoint: codes are so many times a texel, and whole numbers
uniform vec2 empty_code;    // kLossy: what empty space is stored as, and what it is
uniform int apron;          // texels

// The value of a voxel in codes, of which grid values are a multiple plus an offset.
float codeAt(ivec3 texel, int number) {
  float code = texelFetch(atlas, texel, 0).r;
  for (int i = 1; i < kTextures; ++i)
    if (number == i) code = texelFetch(more_atlas[i - 1], texel, 0).r;
  if (kFixedPoint != 0) code = round(code * code_scale);
  if (kLossy != 0 && code == empty_code.x) code = empty_code.y;
  return code;
}

// As a + share (b - a): a share of 0 gives the voxel itself.
float between2(float a, float b, float share) { return a + share * (b - a); }

// The value between four voxels of a plane that along_u and along_v span.
float codeOnPlane(ivec3 texel, int number, ivec3 along_u, ivec3 along_v, vec2 share) {
  float near = between2(codeAt(texel, number), codeAt(texel + along_u, number), share.x);
  float far = between2(codeAt(texel + along_v, number), codeAt(texel + along_u + along_v, number), share.x);
  return between2(near, far, share.y);
}

// The value between eight voxels.
float codeBetween(ivec3 texel, int number, vec3 share) {
  const ivec3 x = ivec3(1, 0, 0), y = ivec3(0, 1, 0), z = ivec3(0, 0, 1);
  return between2(codeOnPlane(texel, number, x, y, share.xy), codeOnPlane(texel + z, number, x, y, share.xy), share.z);
}
