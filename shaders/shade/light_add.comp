// Gives the voxels of some blocks their light on a slab of slices, of the directions that were taken through it by
// light_carry.comp. There is one group for each block.
// Reads   blocks, bricks   which blocks, and where their bricks are
//         through, places, directions  see light_carry.comp
// Writes  light  beside the atlas, share of the whole light, added; kColoured 1: by channel
// SPDX-License-Identifier: Apache-2.0
#include "shade/constants.glsl"
layout(local_size_x = kLitBlock * kLitBlock * kLitBlock) in;
layout(binding = kLightImage, r32f) coherent uniform image3D share_light[kTextures];
layout(binding = kLightImage, rgba32f) coherent uniform image3D coloured_light[kTextures];
struct LitBrick {
  ivec4 texel;  // the first one of its apron, and the number of its texture
  ivec4 voxel;  // the first one that it owns
};
layout(std430, binding = kLitBricksBuffer) readonly buffer Bricks { LitBrick bricks[]; };
layout(std430, binding = kBlocksBuffer) readonly buffer Blocks { uvec2 blocks[]; };  // brick, and number of the block
layout(std430, binding = kThroughBuffer) readonly buffer Through { float through[]; };
layout(std430, binding = kPlacesBuffer) readonly buffer Places { vec4 places[]; };
layout(std430, binding = kDirectionsBuffer) readonly buffer Directions { vec4 directions[]; };
uniform int direction_count;
uniform int first_block;    // of the blocks of the slab
uniform int slab_blocks;    // so many
uniform int first_slice;    // as in light_carry.comp, as are the others
uniform int first_n;
uniform int step_n;
uniform ivec2 plane_size;
uniform int margin;
uniform ivec3 axis_u;
uniform ivec3 axis_v;
uniform ivec3 axis_n;
uniform int apron;
uniform ivec3 interior;
uniform ivec3 block_count;  // of a brick along each axis

int along(ivec3 a, ivec3 axis) { return a.x * axis.x + a.y * axis.y + a.z * axis.z; }

// Returns what the directions bring to a voxel, of place (u, v) in the plane of slice `slice` of the slab: a mean of the
// four paths around it.
vec3 arrivingAt(ivec2 place, int slice) {
  vec3 sum = vec3(0.0);
  for (int k = 0; k < direction_count; ++k) {
    vec2 share = places[(first_slice + slice + 1) * direction_count + k].zw;
    int path = ((k * kSlabSlices + slice) * plane_size.y + place.y) * plane_size.x + place.x;
    float right = through[path] + share.y * (through[path - plane_size.x] - through[path]);
    float left = through[path - 1] + share.y * (through[path - plane_size.x - 1] - through[path - 1]);
    sum += (right + share.x * (left - right)) * directions[k * (1 + kPlanes)].rgb;
  }
  return sum;
}

void add(ivec3 texel, int number, vec3 light) {
  for (int i = 0; i < kTextures; ++i)
    if (number == i) {
      if (kColoured != 0)
        imageStore(coloured_light[i], texel, imageLoad(coloured_light[i], texel) + vec4(light, 0.0));
      else
        imageStore(share_light[i], texel, imageLoad(share_light[i], texel) + vec4(light.r, 0.0, 0.0, 0.0));
    }
}

void main() {
  int group = int(gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x);
  if (group >= slab_blocks) return;
  uvec2 item = blocks[first_block + group];
  LitBrick brick = bricks[item.x];
  int rest = int(item.y);
  ivec3 block = ivec3(rest % block_count.x, rest / block_count.x % block_count.y,
                      rest / (block_count.x * block_count.y));
  // The block's voxels from the brick's first one on, as far as they lie in the slab.
  ivec3 low = mix(kLitBlock * block, ivec3(-apron), equal(block, ivec3(0)));
  ivec3 high = mix(kLitBlock * (block + 1), interior + apron, equal(block, block_count - 1));
  int last_n = first_n + (kSlabSlices - 1) * step_n, brick_n = along(brick.voxel.xyz, axis_n);
  int low_n = max(along(low, axis_n), min(first_n, last_n) - brick_n);
  int high_n = min(along(high, axis_n), max(first_n, last_n) + 1 - brick_n);
  low += (low_n - along(low, axis_n)) * axis_n;
  ivec3 size = high - low;
  size += (high_n - low_n - along(size, axis_n)) * axis_n;
  int count = size.x * size.y * size.z;
  for (int i = int(gl_LocalInvocationID.x); i < count; i += kLitBlock * kLitBlock * kLitBlock) {
    ivec3 local = low + ivec3(i % size.x, i / size.x % size.y, i / (size.x * size.y)), voxel = brick.voxel.xyz + local;
    ivec2 place = ivec2(along(voxel, axis_u), along(voxel, axis_v)) + margin;
    int slice = (along(voxel, axis_n) - first_n) * step_n;
    add(brick.texel.xyz + apron + local, brick.texel.w, arrivingAt(place, slice));
  }
}
