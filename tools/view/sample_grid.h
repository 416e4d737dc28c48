// The value of a grid at a point of the world.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <optional>

#include "umbrick/grid/scalar_grid.h"

namespace umbrick::view {

/// Returns the trilinear value; none where the point lies outside of the grid's active voxels by more than a voxel.
std::optional<double> sampleAt(const ScalarGrid& grid, const glm::dvec3& world);

}  // namespace umbrick::view
