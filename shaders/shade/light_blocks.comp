// Finds the blocks of resident bricks that get light: those with medium in them or next to them. There is one
// invocation for each block. The voxels of a brick's apron belong to its outer blocks.
// Reads   atlas, more_atlas, table (see light_voxels.glsl)   bricks  where they are
// Writes  lit  by brick, then by block, x fastest: 1 where there is medium, else 0
// SPDX-License-Identifier: Apache-2.0
#include "shade/light_voxels.glsl"
layout(local_size_x = 64) in;
struct LitBrick {
  ivec4 texel;  // the first one of its apron, and the number of its texture
  ivec4 voxel;  // the first one that it owns
};
layout(std430, binding = kLitBricksBuffer) readonly buffer Bricks { LitBrick bricks[]; };
layout(std430, binding = kBlocksBuffer) writeonly buffer Blocks { uint lit[]; };
uniform int apron;
uniform ivec3 interior;
uniform ivec3 block_count;  // of a brick along each axis
uniform int first;          // block of the dispatch
uniform int count;          // blocks in all

void main() {
  int number = first + int(gl_GlobalInvocationID.x);
  if (number >= count) return;
  int each = block_count.x * block_count.y * block_count.z, brick = number / each, rest = number - brick * each;
  ivec3 block = ivec3(rest % block_count.x, rest / block_count.x % block_count.y,
                      rest / (block_count.x * block_count.y));
  // The voxels around which a medium reaches into the block by interpolation, and those next to them.
  ivec3 low = kLitBlock * block - 2, high = low + kLitBlock + 3;
  low = max(low, ivec3(-apron));
  high = min(high, interior + apron - 1);
  low = mix(low, ivec3(-apron), equal(block, ivec3(0)));
  high = mix(high, interior + apron - 1, equal(block, block_count - 1));
  ivec3 corner = bricks[brick].texel.xyz + apron;
  float least = 1e38, most = -1e38;
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) {
        float code = codeAt(corner + ivec3(x, y, z), bricks[brick].texel.w);
        least = min(least, code);
        most = max(most, code);
      }
  lit[number] = isTransparent(stepsOf(least), stepsOf(most)) ? 0u : 1u;
}
