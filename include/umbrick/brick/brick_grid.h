// Cuts an OpenVDB grid into bricks.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>

#include "umbrick/brick/bricks.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

/// Tiles, inactive voxels that differ from the background and the background itself are voxels like any other.
/// Voxels that are not finite read as background, a background that is not finite as 0.
/// Work is shared among all cores; memory is a block per thread: voxels stay in the grid until they are read.
/// @throw InvalidArgument  interior not a multiple of 8 in [8, 256], apron outside [1, interior], more than 2^23 bricks
///                         (large tiles cut small), or a brick with its apron beyond the 32-bit coordinates
/// @throw IoError          voxels that a file promised could not be loaded
std::unique_ptr<Bricks> brickGrid(const ScalarGrid& grid, const BrickOptions& options = {});

/// Makes one brick of the whole domain: a picture through it can be compared with one through many bricks. Its lattice
/// begins at domain.min, not at 0. options.interior only tells how the work of finding ranges is divided.
/// @throw InvalidArgument  more than 2^31 voxels, or as brickGrid
/// @throw IoError          as brickGrid
std::unique_ptr<Bricks> unbrickedGrid(const ScalarGrid& grid, const BrickOptions& options = {});

/// Does either, as a scene asks for it (BrickSettings::bricked). @throw InvalidArgument, IoError  as they do
std::unique_ptr<Bricks> cutGrid(const ScalarGrid& grid, const BrickOptions& options, bool bricked);

}  // namespace umbrick
