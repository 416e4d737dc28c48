// What a file holds in the place of a grid that was written to it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <filesystem>

#include "umbrick/grid/float_grid.h"

namespace umbrick {

/// Reads a grid back from a file that writeGrids, writeNanoVdb or writeDense made. A dense
/// file does not tell what is active. Of it one gets `written` with the values that the file has in the box of the
/// active voxels, and voxels whose values differ are active.
/// @param index  place of the grid in the file, in the order in which grids were written
/// @throw IoError  the file is unreadable, or has no such grid, or one with another background or in another place
///                 (by a millionth of a voxel)
openvdb::FloatGrid::ConstPtr readBack(const std::filesystem::path& file, const openvdb::FloatGrid& written,
                                      std::size_t index = 0);

/// The same of a grid of vec3, in a .vdb.
openvdb::Vec3SGrid::ConstPtr readVectorsBack(const std::filesystem::path& file, const openvdb::Vec3SGrid& written,
                                             std::size_t index = 0);

}  // namespace umbrick
