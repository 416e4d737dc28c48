// The values of a part of a grid as a dense array.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "umbrick/core/box.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

/// Copies the voxels of a box, active or not, by all cores. Where the grid stores nothing they have its background.
/// @param out  box.extent() values, x fastest
/// @throw InvalidArgument  the box is empty or out.size() is another one
void copyValues(const ScalarGrid& grid, const IndexBox& box, std::span<float> out);

}  // namespace umbrick
