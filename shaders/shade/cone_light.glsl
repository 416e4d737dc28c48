// The light of a place, found by rays that go from there in each direction of the light, in steps of a voxel. They are
// taken through the cells and segments as view rays are; the run of bricks holds all that they may meet.
// SPDX-License-Identifier: Apache-2.0
#include "shade/ray_segment.glsl"
// RGBA32F, one column for each direction: row 0 a step towards the light, voxels, and its world length; row 1 the
// radiance, and its share of the power of all.
layout(binding = kConeLightsUnit) uniform sampler2D cone_lights;

Ray rayTowards(vec3 step, vec3 place) {
  Ray ray;
  ray.at = place + 0.5 * step;  // segment 0 begins at the place
  ray.step = step;
  ray.per_step = perStep(step);
  ray.stretch = 1.0;
  ray.kept = vec2(-0.5, 1e30);
  clipByPlanes(ray);
  limitTo(1e30, ray);
  return ray;
}

// @param length_of_one  of a segment, world units
float opticalDepth(Ray ray, float length_of_one) {
  const float kOpaque = 20.0;  // exp(-20) is 2e-9
  float tau = 0.0, k = ray.segments.x;
  while (k < ray.segments.y && tau < kOpaque) {
    Crossing crossing = crossingOf(ray, k);
    if (crossing.empty) k = crossing.until;
    float front = max(k - 0.5, ray.kept.x);
    Course course = courseOf(ray, crossing, front);
    for (; k < crossing.until; k += 1.0) {
      float back = max(min(k + 0.5, ray.kept.y), front);
      Slab piece;
      takeSegment(course, front, back, length_of_one * (back - front), piece);
      tau += piece.tau;
      front = back;
    }
  }
  return tau;
}

// Returns the light that gets to a place, and which share of all it is by power. @param place  voxels
vec4 lightAt(vec3 place) {
  vec4 light = vec4(0.0);
  for (int i = 0; i < textureSize(cone_lights, 0).x; ++i) {
    vec4 direction = texelFetch(cone_lights, ivec2(i, 0), 0);
    light += exp(-opticalDepth(rayTowards(direction.xyz, place), direction.w)) * texelFetch(cone_lights, ivec2(i, 1), 0);
  }
  return light;
}
