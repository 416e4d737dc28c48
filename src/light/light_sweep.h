// Takes the light of some directions through the bricks along one axis.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "light/path_lattice.h"
#include "light/slice_planes.h"

namespace umbrick {

/// Directions of one axis and one sign.
struct SweepTask {
  std::vector<SweptDirection> directions;
  /// By direction: the paths whose light is added, by their numbers along u and v; empty: all. Places count from voxel
  /// 0 of index space.
  std::vector<PlaneWindow> paths;
  std::optional<int> firstLit;  // light is added from this slice on, on the way of the light; none: on all
  float factor = 1;             // -1: takes the light away that 1 adds, to the last bit
};

/// Adds the light of a task to the sums. Several threads may call this for the same bricks.
/// @return how many texels of paths were taken through a slice
std::uint64_t sweepLight(SweptBricks& bricks, const SweepTask& task);

}  // namespace umbrick
