// The numbers of a voxel as sources of their own, which share one pass over a file.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <vector>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Returns a source for each number of the voxels. What one of them reads is kept until all others have read it, so
/// that they should be read in step: then no more than what is read at once is held. Not for several threads at once.
/// The error of a slab is the largest of all components.
/// @param source  gives all components
std::vector<std::unique_ptr<VoxelSource>> splitComponents(std::unique_ptr<VoxelSource> source);

}  // namespace umbrick
