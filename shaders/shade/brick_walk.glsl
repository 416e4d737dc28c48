// The way of a pixel's view ray through the cells of the bricks' lattice: bricks, or parts of them that are small enough
// to be empty or solid. Places are counted in voxels from the corner of a brick, so that cell (i, j, k) fills the space
// from (i, j, k) * part on (src/shade/ray_frame.h).
// A ray is cut into segments of equal depth, the same for all rays and all runs of bricks: segment k is what lies
// within half a segment of its middle, which is at  at + k * step.
// SPDX-License-Identifier: Apache-2.0
#include "shade/constants.glsl"
uniform vec2 screen_scale;    // pixels to screen points
uniform vec2 screen_offset;
uniform vec3 first_middle;    // voxels: middle of segment 0 on the view axis
uniform float first_depth;    // world units: its depth
uniform float segment_depth;  // world units: a segment's share of the view axis
uniform vec3 across_x;        // voxels per world unit to the right
uniform vec3 across_y;        // voxels per world unit up
uniform vec3 forward;         // voxels per world unit of depth, along the view axis
uniform float segment_count;
uniform vec4 clip_planes[kClipPlanes > 0 ? kClipPlanes : 1];  // the medium is where dot(xyz, place) + w >= 0

// xyz: the texel at the corner of the cell, without its apron; w: 1 + the texture that it lies in, and kWholeBrick where
// xyz is the corner of the whole brick, all of which is to be walked through. Where w is 0 there is nothing to see, and x
// is the distance to the next cell with something, in steps to any of the 26 neighbours.
layout(binding = kSlotsUnit) uniform usampler3D slots;
// kEnds, R32F: depth along the view axis at which the ray of a pixel ends, world units.
layout(binding = kEndUnit) uniform sampler2D ends;
uniform vec3 part;             // voxels of a cell
uniform vec3 brick;            // voxels of a brick
uniform ivec3 first_cell;      // the first cell of the table
uniform vec3 medium_low;       // there is nothing to see outside of this box, which is not cut at its faces
uniform vec3 medium_high;

struct Ray {
  vec3 at, step;     // voxels
  vec3 per_step;     // segments per voxel along each axis
  float stretch;     // world length per depth
  vec2 segments;     // first segment of the run and the one behind its last
  vec2 kept;         // what is not cut off, in segments: segment k reaches from k - 1/2 to k + 1/2
};

// Returns where the ray is between planes at low and high of each axis, in segments.
vec2 between(Ray ray, vec3 low, vec3 high) {
  vec3 a = (low - ray.at) * ray.per_step, b = (high - ray.at) * ray.per_step;
  vec3 nearer = min(a, b), farther = max(a, b);
  return vec2(max(max(nearer.x, nearer.y), nearer.z), min(min(farther.x, farther.y), farther.z));
}

// Cuts the ray where clip planes end the medium.
void clipByPlanes(inout Ray ray) {
  for (int i = 0; i < kClipPlanes; ++i) {
    float distance = dot(clip_planes[i].xyz, ray.at) + clip_planes[i].w, rate = dot(clip_planes[i].xyz, ray.step);
    if (rate > 0.0)
      ray.kept.x = max(ray.kept.x, -distance / rate);
    else if (rate < 0.0)
      ray.kept.y = min(ray.kept.y, -distance / rate);
    else if (distance < 0.0)
      ray.kept.y = -1e30;
  }
}

// Cuts the ray at the eye, where it ends and where clip planes end the medium.
void clipRay(inout Ray ray) {
  ray.kept = vec2(-first_depth / segment_depth, 1e30);
  if (kEnds != 0)
    ray.kept.y = min(ray.kept.y, (texelFetch(ends, ivec2(gl_FragCoord.xy), 0).r - first_depth) / segment_depth);
  clipByPlanes(ray);
}

// A ray along a face gets an inclination that is lost in rounding, and no division by 0.
vec3 perStep(vec3 step) { return 1.0 / mix(step, vec3(1e-20), lessThan(abs(step), vec3(1e-20))); }

// Leaves of the first `count` segments those that may meet a cell of the run, and medium.
void limitTo(float count, inout Ray ray) {
  vec2 run = between(ray, vec3(first_cell) * part, vec3(first_cell + textureSize(slots, 0)) * part);
  // A segment more at both ends, since rounding may miss one; the cell of its middle decides.
  vec2 seen = between(ray, medium_low, medium_high);
  seen = vec2(max(ray.kept.x, seen.x), min(ray.kept.y, seen.y));
  ray.segments.x = max(max(0.0, ceil(run.x) - 1.0), floor(seen.x + 0.5));
  ray.segments.y = min(min(count, floor(run.y) + 2.0), ceil(seen.y + 0.5));
}

Ray rayThrough(vec2 pixel) {
  vec2 p = pixel * screen_scale + screen_offset;
  vec3 across = p.x * across_x + p.y * across_y;
  Ray ray;
  ray.at = first_middle + (kPerspective != 0 ? first_depth : 1.0) * across;
  ray.step = segment_depth * (kPerspective != 0 ? forward + across : forward);
  ray.per_step = perStep(ray.step);
  ray.stretch = kPerspective != 0 ? sqrt(1.0 + dot(p, p)) : 1.0;
  clipRay(ray);
  limitTo(segment_count, ray);
  return ray;
}

// Returns the cell that the middle of a segment lies in.
vec3 cellOf(Ray ray, float segment) { return floor((ray.at + segment * ray.step) / part); }

// Returns the corner of the box that the middle of a segment lies in, of cells or of bricks. A brick follows from the
// cell: were it found by a division of its own, rounding could make it another one than the cell's.
vec3 cornerOf(Ray ray, float segment, vec3 edge) {
  return floor((cellOf(ray, segment) + 0.5) * part / edge) * edge;
}

// Looks up the cell of a segment; w is 0 outside of the run's cells, too.
uvec4 slotOf(Ray ray, float segment) {
  ivec3 place = ivec3(cellOf(ray, segment)) - first_cell;
  if (any(lessThan(place, ivec3(0))) || any(greaterThanEqual(place, textureSize(slots, 0)))) return uvec4(0u);
  return texelFetch(slots, place, 0);
}

// Returns the first segment whose middle is beyond a box with something in it. Each segment belongs to the one box that
// cornerOf() says, also where rounding would put the exit on the other side of its middle.
float leaves(Ray ray, float segment, vec3 corner, vec3 edge) {
  float until = max(floor(between(ray, corner, corner + edge).y), segment) + 1.0;
  if (until > segment + 1.0 && cornerOf(ray, until - 1.0, edge) != corner) return until - 1.0;
  return cornerOf(ray, until, edge) == corner ? until + 1.0 : until;
}

// Returns the next segment that may meet something, where there is nothing for `distance` cells around.
float skips(Ray ray, float segment, float distance) {
  vec3 corner = cornerOf(ray, segment, part), around = max(distance - 1.0, 0.0) * part;
  return max(floor(between(ray, corner - around, corner + part + around).y), segment) + 1.0;
}

// A cell, or a whole brick, that a ray is in from a segment on.
struct Crossing {
  bool empty;
  float until;     // the first segment beyond it; where it is empty, the next one that may meet something
  int number;      // of the texture that it lies in
  vec3 to_texels;  // from places to texels, without the apron
};

Crossing crossingOf(Ray ray, float segment) {
  uvec4 slot = slotOf(ray, segment);
  vec3 edge = slot.w > uint(kWholeBrick) ? brick : part, corner = cornerOf(ray, segment, edge);
  Crossing crossing;
  crossing.empty = slot.w == 0u;
  crossing.until =
      min(crossing.empty ? skips(ray, segment, float(slot.x)) : leaves(ray, segment, corner, edge), ray.segments.y);
  crossing.number = int(slot.w & uint(kWholeBrick - 1)) - 1;
  crossing.to_texels = vec3(slot.xyz) - corner;
  return crossing;
}
