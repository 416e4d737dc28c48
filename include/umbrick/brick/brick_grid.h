// Cuts an OpenVDB grid into bricks.
#pragma once
#include <memory>
#include <optional>

#include "umbrick/brick/bricks.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

struct BrickOptions {
  int interior = 32;       // owned voxels along each edge, 8 to 256, a multiple of 8 (whole leaves)
  int apron = 1;           // ghost voxels; a sample may lie up to apron - 1/2 voxels outside the brick
  bool gradients = false;  // for 2D transfer functions
};

/// Tiles, inactive voxels that differ from the background and the background itself are voxels like any other.
/// Work is shared among all cores; memory is a block per thread: voxels stay in the grid until they are read.
/// @throw InvalidArgument  interior not a multiple of 8 in [8, 256], apron outside [1, interior]
std::unique_ptr<Bricks> brickGrid(const ScalarGrid& grid, const BrickOptions& options = {});

/// The whole domain as one brick: the path without bricks, to compare with.
/// @throw InvalidArgument  more than 2^31 voxels
std::unique_ptr<Bricks> unbrickedGrid(const ScalarGrid& grid, const BrickOptions& options = {});

}  // namespace umbrick
