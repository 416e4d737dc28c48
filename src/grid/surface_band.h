// The voxels of another lattice that lie close to the surface where a volume has a value.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>

#include "umbrick/grid/float_grid.h"

namespace umbrick {

/// Counts the edges of the volume's lattice along each axis that cross the value.
std::array<std::uint64_t, 3> countCrossings(const openvdb::FloatTree& volume, float value);

/// Returns all voxels that lie in the box around the four cells of the volume that share an edge which crosses the
/// value.
/// @param toBand  from indices of the volume to those of the other lattice
openvdb::MaskTree surfaceVoxels(const openvdb::FloatTree& volume, float value, const glm::dmat4& toBand);

}  // namespace umbrick
