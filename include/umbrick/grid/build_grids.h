// Several dense volumes of one file to a sparse grid each, in one pass over the file.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Builds a grid of each source as buildGrid does, and reads all of them in step, some layers of leaves at a time, as
/// sources of splitComponents want it. The progress of the first options tells how far all are.
/// @param options  one for each source
/// @throw Error    as buildGrid does
/// @pre   all sources have as many slices
std::vector<BuiltGrid> buildGrids(const std::vector<VoxelSource*>& sources, const std::vector<BuildOptions>& options);

}  // namespace umbrick
