// A kit's volume as renderers misread it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "umbrick/core/box.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

struct MisreadGrid {
  ScalarGrid grid;
  std::string sentence;  // follows "the picture agrees when "
};

/// Returns the volume with its voxels in another order, mirrored, half a voxel away, without interpolation and, where
/// the background is not 0, with 0 around it. Large volumes are not rearranged: the list is empty beyond 2^24 voxels.
/// @param box  of the volume's dense voxels
std::vector<MisreadGrid> misreadGrids(const ScalarGrid& grid, const IndexBox& box);

}  // namespace umbrick
