// Takes paths of the light through a slab of slices. There is one invocation for each path of the tiles listed, which
// hold all paths that are next to voxels with light on any of the slices. What a path crosses elsewhere is transparent.
// Reads   atlas, more_atlas, table (see light_voxels.glsl)   slots  cells of bricks
//         tiles, places, directions
// Writes  depths   optical depth of each path so far; a direction's paths are a plane of their own
//         through  transmittance at each path on each slice of the slab, by where the path is on the slice
// SPDX-License-Identifier: Apache-2.0
#include "shade/light_voxels.glsl"
#include "shade/light_cut.glsl"
layout(local_size_x = kPathTile, local_size_y = kPathTile) in;
// As in brick_walk.glsl. Cells are whole bricks.
layout(binding = kSlotsUnit) uniform usampler3D slots;
layout(std430, binding = kTilesBuffer) readonly buffer Tiles { uint tiles[]; };
layout(std430, binding = kDepthsBuffer) buffer Depths { float depths[]; };
layout(std430, binding = kThroughBuffer) writeonly buffer Through { float through[]; };
// By slice on the way of the light, from the one before the first on, then by direction. xy: where path 0 is in the
// plane of a slice, whole voxels; zw: how far behind that voxel, in [0, 1).
layout(std430, binding = kPlacesBuffer) readonly buffer Places { vec4 places[]; };
// By direction: share of the whole light by channel, and length between two slices, world units; then for each plane
// that cuts the medium rate, slices per voxel and cosine (PathCut of umbrick/light/light_paths.h).
layout(std430, binding = kDirectionsBuffer) readonly buffer Directions { vec4 directions[]; };
uniform int direction_count;
uniform int first_tile;      // of the tiles of the slab
uniform int tile_count;
uniform int first_slice;     // of the slab, on the way of the light
uniform int first_n;         // the same as a slice of voxels
uniform int step_n;          // from slice to slice of the way, 1 or -1
uniform ivec2 plane_size;    // voxels
uniform ivec2 path_size;     // paths
uniform int margin;          // voxels of a plane before the first voxel
uniform ivec3 axis_u;        // of voxels, as unit vectors
uniform ivec3 axis_v;
uniform ivec3 axis_n;
uniform int apron;
uniform ivec3 interior;
uniform vec3 per_interior;   // 1 / interior
uniform vec4 planes[kPlanes > 0 ? kPlanes : 1];  // by (u, v, n) of voxels: inside is where dot(xyz, place) + w >= 0
const float kNothing = -1e30;

ivec3 cellOf(ivec3 voxel) { return ivec3(floor((vec3(voxel) + 0.5) * per_interior)); }

uvec4 slotOf(ivec3 cell) {
  if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, textureSize(slots, 0)))) return uvec4(0u);
  return texelFetch(slots, cell, 0);
}

// Finds a brick that holds the four voxels from this one on, if one of them is in a visible brick. Where medium goes on
// beyond the bricks (kContinued), a brick near them is taken, whose outermost voxels count as going on.
uvec4 findBrick(ivec3 voxel, out ivec3 cell) {
  cell = cellOf(voxel);
  uvec4 slot = slotOf(cell);
  if (slot.w != 0u) return slot;
  for (int i = 1; i < 4; ++i) {
    ivec3 other = cellOf(voxel + (i & 1) * axis_u + (i >> 1) * axis_v);
    slot = slotOf(other);
    if (slot.w == 0u) continue;
    cell = other;
    return slot;
  }
  if (kContinued == 0) return slot;
  for (int i = 0; i < 27; ++i) {
    ivec3 other = cellOf(voxel + (apron + 2) * (ivec3(i % 3, i / 3 % 3, i / 9) - 1));
    slot = slotOf(other);
    if (slot.w == 0u) continue;
    cell = other;
    return slot;
  }
  return slot;
}

// Returns the value between four voxels of a slice, in steps; kNothing where there is no brick.
float valueAt(ivec2 place, vec2 share, int n) {
  ivec3 voxel = (place.x - margin) * axis_u + (place.y - margin) * axis_v + n * axis_n, cell;
  uvec4 slot = findBrick(voxel, cell);
  if (slot.w == 0u) return kNothing;
  ivec3 corner = ivec3(slot.xyz) + apron, local = voxel - cell * interior;
  ivec3 low = ivec3(-apron), high = interior + apron - 1;
  int number = int(slot.w & uint(kWholeBrick - 1)) - 1;
  float near_left = codeAt(corner + clamp(local, low, high), number);
  float near_right = codeAt(corner + clamp(local + axis_u, low, high), number);
  float far_left = codeAt(corner + clamp(local + axis_v, low, high), number);
  float far_right = codeAt(corner + clamp(local + axis_u + axis_v, low, high), number);
  // Equal numbers give theirs to the last bit.
  float left = near_left + share.y * (far_left - near_left), right = near_right + share.y * (far_right - near_right);
  return stepsOf(left + share.x * (right - left));
}

// Returns where a path that is at a place (u, v, n) meets the medium.
Kept keptOf(vec3 place, int direction) {
  Kept kept = Kept(-1e9, 1e9, 1.0, 1.0);
  for (int i = 0; i < kPlanes; ++i) {
    vec4 cut = directions[direction * (1 + kPlanes) + 1 + i];
    float crossing = -(dot(planes[i].xyz, place) + planes[i].w) / cut.x;
    if (cut.x <= 0.0)
      kept.leave = min(kept.leave, crossing);
    else if (crossing > kept.enter)
      kept = Kept(crossing, kept.leave, cut.y, cut.z);
  }
  return kept;
}

void main() {
  int group = int(gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x);
  if (group >= tile_count) return;
  uint tile = tiles[first_tile + group];
  uint mask = (1u << kPathTileBits) - 1u;
  int direction = int(tile >> (2 * kPathTileBits));
  ivec2 column = ivec2(tile & mask, tile >> kPathTileBits & mask) - kFirstPathTile;
  vec4 here = places[(first_slice + 1) * direction_count + direction];
  ivec2 path = column * kPathTile + ivec2(gl_LocalInvocationID.xy) - ivec2(here.xy);
  if (any(lessThan(path, ivec2(0))) || any(greaterThanEqual(path, path_size))) return;
  int number = (direction * path_size.y + path.y) * path_size.x + path.x;
  float depth = depths[number], slice_length = directions[direction * (1 + kPlanes)].w;
  here = places[first_slice * direction_count + direction];
  float from = depth < kDarkDepth ? valueAt(path + ivec2(here.xy), here.zw, first_n - step_n) : kNothing;
  for (int slice = 0; slice < kSlabSlices; ++slice) {
    here = places[(first_slice + slice + 1) * direction_count + direction];
    ivec2 place = path + ivec2(here.xy);
    int n = first_n + slice * step_n;
    float light = 0.0;
    if (depth < kDarkDepth) {
      float to = valueAt(place, here.zw, n);
      bool known = min(from, to) > kNothing;
      if (kPlanes == 0) {
        if (known) depth += slice_length * meanSigma(from, to);
        light = expNegative(depth);
      } else {
        Kept kept = keptOf(vec3(vec2(place - margin) + here.zw, n), direction);
        float begin = clamp(kept.enter, -1.0, 0.0), end = max(min(kept.leave, 0.0), begin);
        if (known) depth += slice_length * (end - begin) * meanSigma(to + begin * (to - from), to + end * (to - from));
        light = throughCut(kept, depth, to > kNothing ? sigmaAt(to) : 0.0, slice_length);
      }
      from = to;
    }
    if (all(greaterThanEqual(place, ivec2(0))) && all(lessThan(place, plane_size)))
      through[((direction * kSlabSlices + slice) * plane_size.y + place.y) * plane_size.x + place.x] = light;
  }
  depths[number] = depth;
}
