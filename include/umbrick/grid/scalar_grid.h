// One scalar grid, as 32-bit float, with its name and its affine transform.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <memory>
#include <string>

#include "umbrick/core/box.h"
#include "umbrick/grid/float_grid_fwd.h"

namespace umbrick {

struct ScalarGrid {
  std::shared_ptr<const openvdb::FloatGrid> grid;  // include float_grid.h to look into it
  std::string name;
  double conversionError = 0;  // largest |stored - float| when the file held double or integers beyond 24 bits

  /// @throw InvalidArgument  the transform is not affine
  glm::dmat4 indexToWorld() const;
  /// Bounds of the active voxels' centres; tiles included. Empty for an empty grid.
  IndexBox activeBox() const;
  /// World bounds of activeBox(), of its eight corners.
  Box worldBounds() const;
};

}  // namespace umbrick
