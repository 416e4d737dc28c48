// Voxels of resident bricks as sweeps of light volumes read them: in steps of a table of the transfer function
// (umbrick/light/extinction_table.h), which is the CPU's to the last bit.
// Voxels count from the first one of the first cell of the table of slots.
// SPDX-License-Identifier: Apache-2.0
#include "optics/slab.glsl"
#include "optics/ramp.glsl"
#include "shade/medium.glsl"
layout(binding = kMoreAtlasUnit) uniform sampler3D more_atlas[kRayTextures - 1];
// kTableSteps + 2 integrals of sigma_t, kTableSteps + 1 means of it from each step to the next, and kTableSteps + 1
// numbers of steps before each that have any.
layout(std430, binding = kExtinctionBuffer) readonly buffer Extinction { float table[]; };
// Of a 1D function steps are kTableEnds + (code - lowest_code) * steps_per_code, so that values of the first control point are an entry
// to the last bit. Codes are texels or, of fixed point, the whole numbers that they stand for, of which kCodes is the
// largest.
uniform float lowest_code;
uniform float steps_per_code;
uniform vec2 sigma_ends;   // 1/world unit, of values below the table and above it
uniform vec2 empty_ends;   // there is no medium at values up to the one, and from the other on

// Returns the code of a voxel; of a 2D function (kQuadrature above 1) its sigma_t in steps, which is what is linear between
// voxels then.
float codeAt(ivec3 texel, int number) {
  vec2 value = texelFetch(atlas, texel, 0).rg;
  for (int i = 1; i < kTextures; ++i)
    if (number == i) value = texelFetch(more_atlas[i - 1], texel, 0).rg;
  if (kQuadrature > 1) {
    End end = endOf(vec3(value, 0.0));
    return mediumIn(cellAt(end.stretch), end.value).a * steps_per_code;
  }
  return kCodes > 0 ? roundEven(value.r * float(kCodes)) : value.r;
}

float stepsOf(float code) {
  return kQuadrature > 1 ? code : float(kTableEnds) + (code - lowest_code) * steps_per_code;
}

int entryOf(float steps) { return int(clamp(steps, 0.0, float(kTableSteps))); }

// Returns sigma_t of the step that a value lies in.
float sigmaAt(float steps) { return table[kTableSteps + 2 + entryOf(steps)]; }

// Returns the mean of sigma_t over values that run linearly. Ends count as the nearest steps of the table, beyond which
// sigma_t is constant.
float meanSigma(float from, float to) {
  if (max(from, to) <= empty_ends.x || min(from, to) >= empty_ends.y) return 0.0;
  float a = roundEven(from), b = roundEven(to), last = float(kTableSteps);
  if (a == b) return max(sigmaAt(from), 0.0);
  float sum = table[entryOf(b)] - table[entryOf(a)] + (min(b, 0.0) - min(a, 0.0)) * sigma_ends.x +
              (max(b, last) - max(a, last)) * sigma_ends.y;
  return max(sum / (b - a), 0.0);
}

// Tells whether sigma_t is 0 for all values between two.
bool isTransparent(float low, float high) {
  if ((low < 0.0 && sigma_ends.x > 0.0) || (high > float(kTableSteps) && sigma_ends.y > 0.0)) return false;
  if (high <= empty_ends.x || low >= empty_ends.y) return true;
  int first = 2 * kTableSteps + 3;
  return table[first + min(entryOf(high) + 1, kTableSteps)] == table[first + entryOf(low)];
}
