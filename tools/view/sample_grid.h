// What the viewer asks a grid: its value at a point of the world, and how many voxels it has.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>

#include "umbrick/grid/scalar_grid.h"

namespace umbrick::view {

/// Returns the trilinear value; none where the point lies outside of the grid's active voxels by more than a voxel.
std::optional<double> sampleAt(const ScalarGrid& grid, const glm::dvec3& world);
/// Returns how many voxels are active, those of tiles too.
std::uint64_t activeVoxels(const ScalarGrid& grid);

}  // namespace umbrick::view
