// How the value changes at and around voxels. kBspline: as the gradient of a tricubic B-spline, else by central
// differences; see umbrick/optics/gradient_filter.h.
// SPDX-License-Identifier: Apache-2.0
#include "optics/bspline.glsl"
#include "shade/voxel_fetch.glsl"

// Returns twice the gradient at a voxel, codes per voxel.
vec3 differencesAt(ivec3 texel, int number) {
  const ivec3 x = ivec3(1, 0, 0), y = ivec3(0, 1, 0), z = ivec3(0, 0, 1);
  if (kBspline == 0)
    return vec3(codeAt(texel + x, number) - codeAt(texel - x, number),
                codeAt(texel + y, number) - codeAt(texel - y, number),
                codeAt(texel + z, number) - codeAt(texel - z, number));
  float here = codeAt(texel, number);  // differences from it have more digits
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 27; ++i) {
    ivec3 offset = ivec3(i % 3, i / 3 % 3, i / 9) - 1;
    vec3 along = vec3(offset), weight = (4.0 - 3.0 * abs(along)) / 6.0;
    sum += (codeAt(texel + offset, number) - here) * along * weight.yzx * weight.zxy;
  }
  return sum;
}

// Returns twice the gradient at a place in a cell. @param share  from the cell's first voxel, in [0, 1]
vec3 differencesBetween(ivec3 texel, int number, vec3 share) {
  const ivec3 x = ivec3(1, 0, 0), y = ivec3(0, 1, 0), z = ivec3(0, 0, 1);
  if (kBspline == 0)
    return vec3(codeBetween(texel + x, number, share) - codeBetween(texel - x, number, share),
                codeBetween(texel + y, number, share) - codeBetween(texel - y, number, share),
                codeBetween(texel + z, number, share) - codeBetween(texel - z, number, share));
  float here = codeAt(texel, number);
  vec4 weight_x = bsplineWeights(share.x), weight_y = bsplineWeights(share.y), weight_z = bsplineWeights(share.z);
  vec4 slope_x = bsplineSlopes(share.x), slope_y = bsplineSlopes(share.y), slope_z = bsplineSlopes(share.z);
  vec3 sum = vec3(0.0);
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j) {
      ivec3 row = texel + ivec3(-1, j - 1, k - 1);
      vec4 codes = vec4(codeAt(row, number), codeAt(row + x, number), codeAt(row + 2 * x, number),
                        codeAt(row + 3 * x, number)) - here;
      float value = dot(codes, weight_x);
      sum += vec3(dot(codes, slope_x) * weight_y[j] * weight_z[k], value * slope_y[j] * weight_z[k],
                  value * weight_y[j] * slope_z[k]);
    }
  return 2.0 * sum;
}
