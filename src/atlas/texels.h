// Voxels as the texels of a format.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <span>

#include "umbrick/atlas/brick_atlas.h"

namespace umbrick {

/// Writes the texels of a brick: values, each followed by its gradient magnitude where there are gradients, and by that
/// (or 0) and the value of the second grid where there is one, which is for 32-bit floats alone.
/// @param scale   that of the volume in this format, see texelScale
/// @param texels  has room for all of them
/// @return the largest |voxel - texel|, grid units; 0 for an exact format
double encodeTexels(std::span<const float> values, std::span<const float> gradients, const TexelScale& scale,
                    VoxelFormat format, std::byte* texels, std::span<const float> emission = {});

}  // namespace umbrick
