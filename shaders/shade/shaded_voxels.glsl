// Phong's model in a medium: what the voxels of a cell reflect, interpolated as values are. The shares multiply albedos.
// SPDX-License-Identifier: Apache-2.0
#include "shade/phong_lights.glsl"
#include "shade/voxel_gradient.glsl"
uniform vec3 index_to_world[3];  // world units per voxel
uniform vec3 from_eye;           // from the eye to the first voxel that places are counted from, world units

// @param place  of the voxel, voxels from there
vec3 reflectedAtVoxel(ivec3 texel, int number, vec3 place, vec3 arriving) {
  vec3 viewer = -view_forward;
  if (kPerspective != 0)
    viewer = -normalize(from_eye + place.x * index_to_world[0] + place.y * index_to_world[1] +
                        place.z * index_to_world[2]);
  return reflectedBy(vec3(1.0), normalOf(differencesAt(texel, number), viewer), viewer, arriving);
}

// @param point  in the atlas, texels, where voxels are at whole numbers; shift: from there to places
// @param arriving  share of the light that reaches the point
vec3 reflectedBetween(vec3 point, int number, vec3 shift, vec3 arriving) {
  vec3 voxel = floor(point), share = point - voxel, sum = vec3(0.0);
  for (int corner = 0; corner < 8; ++corner) {
    ivec3 upper = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    vec3 weights = mix(1.0 - share, share, vec3(upper));
    ivec3 texel = ivec3(voxel) + upper;
    sum += weights.x * weights.y * weights.z * reflectedAtVoxel(texel, number, vec3(texel) + shift, arriving);
  }
  return sum;
}
