// Datasets of HDF5 files as volumes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>

#include "umbrick/ingest/volume_parts.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Opens the dataset "file.h5:/group/dataset", or the only one of three axes for "file.h5", or else the only one that
/// has frames or components as well. It may hold integers of 8 to 64 bits or floats of 16 to 64 bits, in either byte
/// order, contiguous or in chunks with every filter that libhdf5 has. Two axes make one slice; of more than three, one
/// may be of frames and one of components, which VolumeInfo::notes tell, and others of length 1 are dropped. Slabs are
/// read one by one; a chunk that reaches into the next slab is unpacked once and kept.
///
/// The last axis, which is the fastest, is x. A dataset states no place: voxels are 1 apart and the first is at 0.
///
/// @throw IoError       missing, truncated, no such dataset, several to choose from (they are listed), another type or
///                      rank
/// @throw SeveralParts  frames or components, of which `parts` chooses none
std::unique_ptr<VoxelSource> openHdf5(const std::filesystem::path& path, const PartChoice& parts = {},
                                      bool besideOnly = false);

/// True for "file:/dataset" where the file exists and is HDF5.
bool isHdf5Dataset(const std::filesystem::path& path);

}  // namespace umbrick
