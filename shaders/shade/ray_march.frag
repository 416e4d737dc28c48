// Marches the view ray of a pixel through the bricks of one run, from segment to segment, nearest first.
// Reads   atlas, more_atlas, transfer (see medium.glsl)   slots (see brick_walk.glsl)
//         light, more_light  kLit: see light_share.glsl
//         cone_lights  kConeRays: see cone_light.glsl
//         start  kStarts, R32F: depth along the view axis from which the ray sees the medium, world units
//         kShaded: the medium reflects lights by Phong's model, see shaded_voxels.glsl
// Writes  eye    premultiplied RGBA, blended under what is nearer: (ONE_MINUS_DST_ALPHA, ONE)
//         count  number of segments, added
//         aux    kAux: opacity-weighted visibility and depth, blended as eye
// Source: Krüger and Westermann 2003, doi:10.1109/VISUAL.2003.1250384
// SPDX-License-Identifier: Apache-2.0
#include "optics/slab.glsl"
#include "optics/ramp.glsl"
#include "shade/brick_walk.glsl"
#include "shade/cone_light.glsl"
#include "shade/light_share.glsl"
#include "shade/medium.glsl"
#include "shade/ray_segment.glsl"
#include "shade/shaded_voxels.glsl"
layout(binding = kStartUnit) uniform sampler2D start;
uniform float saturation;        // transmittance below which a ray ends
uniform vec2 drawn_segments;     // kConeRays: the first one that is drawn and the one behind the last
layout(location = 0) out vec4 eye;
layout(location = 1) out float count;
layout(location = 2) out vec4 aux;

void main() {
  Ray ray = rayThrough(gl_FragCoord.xy);
  if (kStarts != 0) {
    ray.kept.x = max(ray.kept.x, (texelFetch(start, ivec2(gl_FragCoord.xy), 0).r - first_depth) / segment_depth);
    // An endless way to the start is longer than what is left of the ray.
    ray.segments.x = max(ray.segments.x, min(floor(ray.kept.x + 0.5), ray.segments.y));
  }
  if (kConeRays != 0)
    ray.segments = vec2(max(ray.segments.x, drawn_segments.x), min(ray.segments.y, drawn_segments.y));
  float length_of_one = ray.stretch * segment_depth, full = 1.0 - saturation;
  vec4 sum = vec4(0.0);
  vec2 seen = vec2(0.0);  // visibility and depth, weighted by opacity
  vec3 glow = vec3(0.0);
  float segments = 0.0, k = ray.segments.x, last = ray.segments.y;
  while (k < last) {
    Crossing crossing = crossingOf(ray, k);
    if (crossing.empty) k = crossing.until;
    float front = max(k - 0.5, ray.kept.x);
    Course course = courseOf(ray, crossing, front);
    while (k < crossing.until) {
      float back = max(min(k + 0.5, ray.kept.y), front), middle = 0.5 * (front + back);
      Slab piece;
      if (takeSegment(course, front, back, length_of_one * (back - front), piece)) {
        vec4 arriving = vec4(1.0);
        if (kLit != 0) arriving = arrivingAt(course.at + middle * course.step, course.number);
        if (kConeRays != 0 && piece.tau > 0.0)
          arriving = lightAt(ray.at + (front + placeSeen(piece.tau) * (back - front)) * ray.step);
        // What is reflected is light and all; the medium's own visibility is no part of it.
        if (kShaded != 0)
          arriving = vec4(reflectedBetween(ray.at + middle * ray.step + course.to_texels - 0.5, course.number,
                                           -course.to_texels, arriving.rgb), 1.0);
        float through = 1.0 - sum.a;
        sum += through * vec4(piece.eye.rgb * arriving.rgb, piece.eye.a);
        glow += through * piece.emitted;
        seen += through * piece.eye.a * vec2(arriving.a, first_depth + middle * segment_depth);
      }
      front = back;
      segments += 1.0;
      k += 1.0;
      if (sum.a > full) last = crossing.until = k;
    }
  }
  eye = kLit != 0 && kShaded == 0 ? vec4(sum.rgb * whole_light, sum.a) : sum;
  eye.rgb = withEmission(eye.rgb, glow);
  count = segments;
  if (kAux != 0) aux = vec4(seen, 0.0, sum.a);
}
