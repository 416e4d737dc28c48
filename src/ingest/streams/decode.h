// Turns voxels as they are stored into floats.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstddef>
#include <span>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// How one voxel lies in the file.
struct VoxelLayout {
  VoxelType type = VoxelType::u8;
  std::endian endian = std::endian::little;
  int bitsStored = 0;  // 0: all; else the bits above are masked off and signed types sign-extended from the last one
  double slope = 1, intercept = 0;  // value = slope * stored + intercept
};

/// Decodes out.size() voxels. Finite doubles beyond the range of float become the largest float.
/// @return the largest |value - float| of the finite values
double decodeVoxels(const VoxelLayout& layout, std::span<const std::byte> in, std::span<float> out);

/// Makes the stored values those of this machine, in place: its byte order, and no flag bits.
void normaliseVoxels(const VoxelLayout& layout, std::span<std::byte> voxels);

}  // namespace umbrick
