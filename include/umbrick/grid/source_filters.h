// Sources made of other sources: a part, a masked one; and the value that most of a volume's border has.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>

#include "umbrick/core/box.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Makes a source of the voxels in a box of indices, both ends included. Their indices begin at 0 anew; indexToWorld
/// moves with them, so that each voxel stays where it is in the world.
/// @throw InvalidArgument  the box is empty or not inside the volume
std::unique_ptr<VoxelSource> cropSource(std::unique_ptr<VoxelSource> source, const IndexBox& box);

/// Makes a source in which voxels where the mask is 0 are `background`. A mask voxel that is NaN counts as not 0.
/// Notes of the mask become notes of the source.
/// @param leftOut  if not null, becomes the number of voxels that this changes
/// @throw InvalidArgument  the mask has other dims, or places a corner farther off than a thousandth of a voxel
std::unique_ptr<VoxelSource> maskSource(std::unique_ptr<VoxelSource> source, std::unique_ptr<VoxelSource> mask,
                                        float background, std::uint64_t* leftOut = nullptr);

/// The most frequent value of the voxels on the six faces of a volume.
struct BorderMode {
  float value = 0;                       // grid units; the smaller of two that are equally frequent
  std::uint64_t voxels = 0, border = 0;  // voxels that have it, and voxels of the border, without NaN and infinite ones
  std::uint64_t different = 0;           // values that the border has
  float median = 0;                      // grid units, of the border
};

/// Reads the source to its end. It counts up to 2^20 different values; values first met after these are not counted.
/// @throw InvalidArgument  no voxel of the border is finite
BorderMode borderValues(VoxelSource& source);

/// Does the same where one value must stand out. @throw InvalidArgument  no two voxels of the border have the same
/// value, or none is finite
BorderMode borderMode(VoxelSource& source);

}  // namespace umbrick
