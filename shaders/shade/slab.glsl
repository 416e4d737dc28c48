// What one fragment finds in its slab.
// SPDX-License-Identifier: Apache-2.0
#include "optics/slab.glsl"
#include "optics/ramp.glsl"
#include "shade/ray.glsl"
#include "shade/clip.glsl"
#include "shade/medium.glsl"

// Evaluates the part of the slab that clip planes leave, along the fragment's view ray.
Slab evaluateSlab(vec4 slab_centre) {
  vec2 p = screenPoint();
  vec3 middle = slabMiddle(slab_centre, p);
  vec3 half_step = slabHalf(p);
  vec2 kept = vec2(-1.0, 1.0);
  if (kClipPlanes > 0) {
    kept = keptInterval(p, viewDepth(slab_centre, p), halfDepth(p));
    kept.y = max(kept.x, kept.y);
  }
  float thickness = kept.y - kept.x;
  float ray = rayStretch(p) * halfDepth(p) * thickness / float(kSegments);  // world length of a segment
  vec3 segment = half_step * (thickness / float(kSegments));
  vec3 front = middle + kept.x * half_step;
  Slab slab = emptySlab();
  if (kQuadrature == 1 || kQuadrature == 3) {
    for (int i = 0; i < kSegments; ++i) addMiddle(slab, endAt(front + (float(i) + 0.5) * segment), ray);
    return slab;
  }
  End front_end = endAt(front);
  for (int i = 0; i < kSegments; ++i) {
    End back_end = endAt(front + float(i + 1) * segment);
    addSegment(slab, front_end, back_end, ray);
    front_end = back_end;
  }
  return slab;
}
