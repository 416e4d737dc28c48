// Marches the view ray of a pixel through the bricks of one run, from segment to segment, nearest first. The ends of a
// segment are shared with its neighbours, so that a value is read once where slices read it twice.
// Reads   atlas, more_atlas, transfer (see medium.glsl)   slots (see brick_walk.glsl)
//         light, more_light  kLit: see light_share.glsl
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
#include "shade/light_share.glsl"
#include "shade/medium.glsl"
#include "shade/shaded_voxels.glsl"
#include "shade/voxel_fetch.glsl"
layout(binding = kStartUnit) uniform sampler2D start;
uniform vec3 inverse_size;       // of the atlas's textures
uniform float saturation;        // transmittance below which a ray ends
layout(location = 0) out vec4 eye;
layout(location = 1) out float count;
layout(location = 2) out vec4 aux;

vec3 texelAt(vec3 point, int number) {
  vec3 texel = textureLod(atlas, point, 0.0).rgb;
  for (int i = 1; i < kTextures; ++i)
    if (number == i) texel = textureLod(more_atlas[i - 1], point, 0.0).rgb;
  return texel;
}

// Tells whether a segment between two values may hold any medium, or emit something. Most segments of most volumes hold none.
bool shows(End front, End back) {
  if (kEmission != 0 || kQuadrature > 1 || front.stretch.x != back.stretch.x) return true;
  vec4 ends = stretchAt(front.stretch.x).ends;
  return max(ends.b, ends.a) > 0.0;
}

void main() {
  Ray ray = rayThrough(gl_FragCoord.xy);
  if (kStarts != 0) {
    ray.kept.x = max(ray.kept.x, (texelFetch(start, ivec2(gl_FragCoord.xy), 0).r - first_depth) / segment_depth);
    // An endless way to the start is longer than what is left of the ray.
    ray.segments.x = max(ray.segments.x, min(floor(ray.kept.x + 0.5), ray.segments.y));
  }
  float length_of_one = ray.stretch * segment_depth, full = 1.0 - saturation;
  vec4 sum = vec4(0.0);
  vec2 seen = vec2(0.0);  // visibility and depth, weighted by opacity
  vec3 glow = vec3(0.0);
  float segments = 0.0, k = ray.segments.x, last = ray.segments.y;
  while (k < last) {
    uvec4 slot = slotOf(ray, k);
    bool empty = slot.w == 0u;
    vec3 edge = slot.w > uint(kWholeBrick) ? brick : part, corner = cornerOf(ray, k, edge);
    float until = min(empty ? skips(ray, k, float(slot.x)) : leaves(ray, k, corner, edge), last);
    if (empty) k = until;
    int number = int(slot.w & uint(kWholeBrick - 1)) - 1;
    // Atlas coordinates along the ray.
    vec3 to_texels = vec3(slot.xyz) + float(apron) - corner;
    vec3 at = (ray.at + to_texels) * inverse_size;
    vec3 step = ray.step * inverse_size;
    float front = max(k - 0.5, ray.kept.x);
    End front_end;
    if (kQuadrature == 0 || kQuadrature == 2) front_end = endOf(texelAt(at + front * step, number));
    while (k < until) {
      float back = max(min(k + 0.5, ray.kept.y), front);
      float middle = 0.5 * (front + back), length_of_this = length_of_one * (back - front);
      End back_end = endOf(texelAt(at + (kQuadrature == 1 || kQuadrature == 3 ? middle : back) * step, number));
      if (kQuadrature == 1 || kQuadrature == 3) front_end = back_end;
      if (shows(front_end, back_end)) {
        Slab piece = emptySlab();
        if (kQuadrature == 1 || kQuadrature == 3)
          addMiddle(piece, back_end, length_of_this);
        else
          addSegment(piece, front_end, back_end, length_of_this);
        vec4 arriving = kLit != 0 ? arrivingAt(at + middle * step, number) : vec4(1.0);
        // What is reflected is light and all; the medium's own visibility is no part of it.
        if (kShaded != 0)
          arriving = vec4(reflectedBetween(ray.at + middle * ray.step + to_texels - 0.5, number, -to_texels,
                                           arriving.rgb), 1.0);
        float through = 1.0 - sum.a;
        sum += through * vec4(piece.eye.rgb * arriving.rgb, piece.eye.a);
        glow += through * piece.emitted;
        seen += through * piece.eye.a * vec2(arriving.a, first_depth + middle * segment_depth);
      }
      front = back;
      front_end = back_end;
      segments += 1.0;
      k += 1.0;
      if (sum.a > full) last = until = k;
    }
  }
  eye = kLit != 0 && kShaded == 0 ? vec4(sum.rgb * whole_light, sum.a) : sum;
  eye.rgb = withEmission(eye.rgb, glow);
  count = segments;
  if (kAux != 0) aux = vec4(seen, 0.0, sum.a);
}
