// The values of a dense volume: range, histogram, and what is no number.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// A summary of the finite voxels, as 32-bit floats.
struct VolumeValues {
  float min = 0, max = 0;                // NaN where no voxel is finite
  std::vector<std::uint64_t> histogram;  // equal bins from min to max, both ends included; empty without finite voxels
  std::uint64_t nonFinite = 0;           // voxels that are NaN or infinite
  double conversionError = 0;            // largest |stored - float|
};

/// Reads a volume twice, since bins are known when the range is.
/// @param open  opens it, each time anew
/// @param bins  1 or more
/// @throw IoError  as the source does
VolumeValues volumeValues(const std::function<std::unique_ptr<VoxelSource>()>& open, int bins);

}  // namespace umbrick
