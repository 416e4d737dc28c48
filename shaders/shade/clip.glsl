// The part of a slab that clip planes leave, along one ray.
// Planes as in umbrick/slice/proxy_slices.h: kept where dot(xyz, view coordinates) + w >= 0.
// SPDX-License-Identifier: Apache-2.0
uniform vec4 clip_planes[kClipPlanes > 0 ? kClipPlanes : 1];

// Returns front and back of what is kept: -1 is the slab's front, 1 its back; nothing is kept when front >= back.
// @param depth  of the slab's middle along the view axis; half_depth: from there to its back
vec2 keptInterval(vec2 p, float depth, float half_depth) {
  vec2 kept = vec2(-1.0, 1.0);
  for (int i = 0; i < kClipPlanes; ++i) {
    vec4 plane = clip_planes[i];
    float across = dot(plane.xy, p);
    float rate = kPerspective != 0 ? plane.z + across : plane.z;     // change of distance per depth
    float distance = (kPerspective != 0 ? 0.0 : across) + plane.w + rate * depth;
    float change = rate * half_depth;                                // from the middle to the back
    if (change > 0.0)
      kept.x = max(kept.x, -distance / change);
    else if (change < 0.0)
      kept.y = min(kept.y, -distance / change);
    else if (distance < 0.0)
      kept.y = -2.0;
  }
  return kept;
}
