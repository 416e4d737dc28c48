// Tells where a fragment's view ray crosses the slab of its slice.
// Screen points, depths and atlas coordinates are those of umbrick/core/camera.h and umbrick/brick/bricks.h: screen
// point p stands for the point  eye + s (forward + p.x right + p.y up)  at depth s under perspective.
// SPDX-License-Identifier: Apache-2.0
uniform vec2 screen_scale;    // pixels to screen points
uniform vec2 screen_offset;
uniform vec3 across_x;        // atlas coordinates per unit to the right, on the slice
uniform vec3 across_y;        // atlas coordinates per unit up, on the slice
uniform vec3 half_forward;    // atlas coordinates from the middle of the slab to its back, along the view axis
uniform float half_spacing;   // world units along the view axis

vec2 screenPoint() { return gl_FragCoord.xy * screen_scale + screen_offset; }

// Returns the atlas coordinates of the ray on the slice's middle.
vec3 slabMiddle(vec4 slab, vec2 p) {
  float scale = kPerspective != 0 ? slab.w : 1.0;
  return slab.xyz + scale * (p.x * across_x + p.y * across_y);
}

// Returns the difference of atlas coordinates from the middle of the slab to its back, along the ray.
vec3 slabHalf(vec2 p) {
  if (kPerspective == 0) return half_forward;
  return half_forward + half_spacing * (p.x * across_x + p.y * across_y);
}

// Returns the world length of the ray per unit of depth.
float rayStretch(vec2 p) { return kPerspective != 0 ? sqrt(1.0 + dot(p, p)) : 1.0; }
