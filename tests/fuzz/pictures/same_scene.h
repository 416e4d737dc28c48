// Scenes that must make the same picture as another one, by the model.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "umbrick/grid/scalar_grid.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

struct SameScene {
  std::string name;
  ScalarGrid grid;
  ResolvedScene scene;
};

/// What must change no picture but for rounding:
///   unbricked, edge, not culled, float32   other bricks and texels of the same voxels
///   turned    other index axes, two of them exchanged and one reversed; the voxels stay where they are
///   shifted   other indices, by numbers that are no multiples of a brick's edge; the voxels stay where they are
///   padded    a border of active voxels that hold the background, where the background is not seen
///   scaled    the world, its camera and planes by a factor, extinction (and gradients of a 2D function) by the inverse
///   moved     the world, its camera and planes by a vector
/// @param seed  of factors, vectors and edges
/// @param apron that the scene needs, voxels
std::vector<SameScene> sameScenes(const ScalarGrid& grid, const ResolvedScene& scene, int apron, std::uint64_t seed);

}  // namespace umbrick
