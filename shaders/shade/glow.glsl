// Light that a second grid emits, by the values of its voxels in the third channel of the atlas.
// SPDX-License-Identifier: Apache-2.0
#include "shade/constants.glsl"
// kEmission, RGBA32F: row 0 is the radiance per world unit at equal steps of the value, row 1 the integral of it over the
// steps before.
layout(binding = kEmissionUnit) uniform sampler2D emission;
uniform vec3 emission_steps;  // x: value of step 0; y: steps per unit of the value; z: the last step
uniform vec3 ambient;         // radiance of light 1, where something is emitted besides

vec3 emissionAt(float step, int row) {
  float within = clamp(step, 0.0, emission_steps.z), whole = min(floor(within), emission_steps.z - 1.0);
  vec3 low = texelFetch(emission, ivec2(int(whole), row), 0).rgb;
  return low + (within - whole) * (texelFetch(emission, ivec2(int(whole) + 1, row), 0).rgb - low);
}

// Returns the integral up to a step; beyond its ends the function is constant.
vec3 emissionUpTo(float step) {
  float within = clamp(step, 0.0, emission_steps.z);
  return emissionAt(within, 1) + (step - within) * emissionAt(within, 0);
}

// Returns the mean radiance per world unit over values that run linearly. Over few steps the difference of two sums
// would be rounded too much: there it is that of three of them.
vec3 meanEmission(float from, float to) {
  float a = (from - emission_steps.x) * emission_steps.y, b = (to - emission_steps.x) * emission_steps.y;
  if (abs(b - a) < 16.0)
    return (emissionAt(a, 0) + 4.0 * emissionAt(0.5 * (a + b), 0) + emissionAt(b, 0)) * (1.0 / 6.0);
  return (emissionUpTo(b) - emissionUpTo(a)) / (b - a);
}

// Returns what a part of a ray sends to the eye: what it scatters, for light of radiance 1, and what it emits.
vec3 withEmission(vec3 scattered, vec3 emitted) {
  return kEmission != 0 ? scattered * ambient + emitted : scattered;
}
