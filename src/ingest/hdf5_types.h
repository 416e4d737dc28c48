// Which types of numbers of HDF5 are voxels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <hdf5.h>

#include <optional>
#include <string>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// How the numbers of a dataset are stored, and the type in memory that libhdf5 reads them as.
struct Hdf5Number {
  VoxelType stored = VoxelType::u8, read = VoxelType::u8;
};
/// Nothing for a dataset that holds no numbers, or such as are not read.
std::optional<Hdf5Number> hdf5Number(hid_t dataset);

/// Names the type of a dataset that is not read, in the words of those who write such files.
std::string hdf5TypeText(hid_t dataset);

/// The type of libhdf5 for numbers in memory.
hid_t hdf5MemoryType(VoxelType type);

}  // namespace umbrick
