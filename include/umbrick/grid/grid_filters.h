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

/// What lies outside a box of indices, both ends included, becomes inactive background. Indices and transform stay.
/// @throw InvalidArgument  no active voxel lies in the box; a level set, whose surface it would cut open
void cropGrid(openvdb::FloatGrid& grid, const IndexBox& box);

/// Voxels stay active where an active voxel of the mask at the same index is not 0; all others become background.
/// @return how many that are active are not thereafter
/// @throw InvalidArgument  the mask's background is not 0; it places a corner of the grid's active voxels further off
/// than
///                         a thousandth of a voxel; a level set
std::uint64_t maskGrid(openvdb::FloatGrid& grid, const openvdb::FloatGrid& mask);

/// The voxels (0, 0, 0) to dims - 1 of a grid, active or not.
/// @param name  what messages call it
/// @throw InvalidArgument  a transform that is not affine
std::unique_ptr<VoxelSource> gridSource(std::string name, std::shared_ptr<const openvdb::FloatGrid> grid,
                                        const glm::i64vec3& dims);

}  // namespace umbrick
