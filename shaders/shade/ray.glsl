// Tells where a fragment's view ray crosses the slab of its slice.
// Screen points, depths and atlas coordinates are those of umbrick/core/camera.h and umbrick/brick/bricks.h: screen
// point p stands for the point  eye + s (forward + p.x right + p.y up)  at depth s under perspective.
// SPDX-License-Identifier: Apache-2.0
uniform vec2 screen_scale;    // pixels to screen points
uniform vec2 screen_offset;
uniform vec3 across_x;        // atlas coordinates per unit to the right, on the slice
uniform vec3 across_y;        // atlas coordinates per unit up, on the slice
uniform vec3 half_forward;    // atlas coordinates from the middle of the slab to its back, along the view axis
uniform float half_spacing;   // world units along the view axis; of stacks: units of depth
// Of stacks (kStack != 0) depth counts along an axis of the volume, see umbrick/slice/stack_slices.h.
uniform vec3 stack_rate;      // how it grows with view coordinates
uniform vec2 stack_point;     // slabs are looked up here, not at the centre of the image
uniform vec3 per_view_depth;  // atlas coordinates per world unit along the view axis
// kStack == 2: rays of the image belong to several stacks.
uniform vec3 index_right, index_up, index_forward;  // index coordinates per unit of the view axes
uniform int stack_axis, stack_sign;

vec2 screenPoint() { return gl_FragCoord.xy * screen_scale + screen_offset; }

// Tells whether the ray is one of the stack that is drawn: it runs along its axis more than along the others. All
// stacks compare the same numbers, so that each ray belongs to one.
bool liesInStack(vec2 p) {
  vec3 along = index_right * p.x + index_up * p.y + index_forward, size = abs(along);
  int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return axis == stack_axis && along[axis] * float(stack_sign) > 0.0;
}

// How the depth of a slab grows with depth along the view axis, on the ray.
float depthRate(vec2 p) {
  if (kStack == 0) return 1.0;
  return kPerspective != 0 ? dot(stack_rate, vec3(p, 1.0)) : stack_rate.z;
}

// Returns where the ray meets the middle of the slab, depth along the view axis.
float viewDepth(vec4 slab, vec2 p) {
  if (kStack == 0) return slab.w;
  return (kPerspective != 0 ? slab.w : slab.w - dot(stack_rate.xy, p)) / depthRate(p);
}

// Returns the depth along the view axis from the middle of the slab to its back, on the ray.
float halfDepth(vec2 p) { return half_spacing / depthRate(p); }

// Returns the atlas coordinates of the ray on the slice's middle.
vec3 slabMiddle(vec4 slab, vec2 p) {
  if (kStack != 0) {
    // Differences to the point that the slab is looked up at, so that nothing cancels far from the eye.
    vec2 across = kPerspective != 0 ? p - stack_point : p;
    float scale = kPerspective != 0 ? viewDepth(slab, p) : 1.0;
    float deeper = -scale * dot(stack_rate.xy, across) / depthRate(stack_point);
    vec2 aside = scale * across + (kPerspective != 0 ? stack_point * deeper : vec2(0.0));
    return slab.xyz + aside.x * across_x + aside.y * across_y + deeper * per_view_depth;
  }
  float scale = kPerspective != 0 ? slab.w : 1.0;
  return slab.xyz + scale * (p.x * across_x + p.y * across_y);
}

// Returns the difference of atlas coordinates from the middle of the slab to its back, along the ray.
vec3 slabHalf(vec2 p) {
  if (kStack != 0)
    return halfDepth(p) * (per_view_depth + (kPerspective != 0 ? p.x * across_x + p.y * across_y : vec3(0.0)));
  if (kPerspective == 0) return half_forward;
  return half_forward + half_spacing * (p.x * across_x + p.y * across_y);
}

// Returns the world length of the ray per unit of depth.
float rayStretch(vec2 p) { return kPerspective != 0 ? sqrt(1.0 + dot(p, p)) : 1.0; }
