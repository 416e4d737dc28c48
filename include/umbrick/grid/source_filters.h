// Sources made of other sources: a part, a masked one; and the value that most of a volume's border has.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>

#include "umbrick/core/box.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// The voxels of a box of indices, both ends included. They begin at index 0 anew; indexToWorld moves with them, so
/// that each stays where it is in the world.
/// @throw InvalidArgument  the box is empty or not inside the volume
std::unique_ptr<VoxelSource> cropSource(std::unique_ptr<VoxelSource> source, const IndexBox& box);

/// Voxels where the mask is 0 become `background`. A mask voxel that is NaN counts as not 0.
/// @param leftOut  if not null, becomes the number of voxels that this changes
/// @throw InvalidArgument  the mask has other dims, or places a corner further off than a thousandth of a voxel
std::unique_ptr<VoxelSource> maskSource(std::unique_ptr<VoxelSource> source, std::unique_ptr<VoxelSource> mask,
                                        float background, std::uint64_t* leftOut = nullptr);

/// The most frequent value of the voxels on the six faces of a volume.
struct BorderMode {
  float value = 0;                       // the smaller one of two that are as frequent
  std::uint64_t voxels = 0, border = 0;  // that have it, of how many; NaN and infinite ones are not looked at
};

/// Reads the source to its end. Of values met after 2^20 different ones the new ones are not counted.
/// @throw InvalidArgument  no two voxels of the border have the same value, or none is finite
BorderMode borderMode(VoxelSource& source);

}  // namespace umbrick
