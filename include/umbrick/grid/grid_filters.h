// Parts of grids, by a box or a mask; and a grid as the dense volume that it would be.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "umbrick/core/box.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Makes all that lies outside a box of indices (both ends included) inactive background. Indices and transform stay.
/// @throw InvalidArgument  no active voxel lies in the box, or the grid is a level set, whose surface would be cut open
void cropGrid(openvdb::FloatGrid& grid, const IndexBox& box);

/// Keeps voxels active where an active voxel of the mask at the same index is not 0. All others become background.
/// @return the number of voxels that were active and are so no more
/// @throw InvalidArgument  the background of the mask is not 0, the mask places a corner of the grid's active voxels
///                         farther off than a thousandth of a voxel, or the grid is a level set
std::uint64_t maskGrid(openvdb::FloatGrid& grid, const openvdb::FloatGrid& mask);

/// Reads the voxels (0, 0, 0) to dims - 1 of a grid, active or not, as a dense volume, which states the
/// world that the grid states.
/// @param name  what messages call the volume
/// @throw InvalidArgument  the transform is not affine
std::unique_ptr<VoxelSource> gridSource(std::string name, std::shared_ptr<const openvdb::FloatGrid> grid,
                                        const glm::i64vec3& dims);

}  // namespace umbrick
