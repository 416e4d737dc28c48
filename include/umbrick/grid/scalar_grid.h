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
  std::shared_ptr<const openvdb::FloatGrid> grid;  // float_grid.h must be included to look into it
  std::string name;
  /// Grid units; not 0 when the file held doubles or integers beyond 24 bits: largest |stored - float|.
  double conversionError = 0;
  /// Values of a second grid, which emits light, on the lattice of this one; none: nothing emits. See
  /// emission_grid.h.
  std::shared_ptr<const openvdb::FloatGrid> emission = {};

  /// True for a grid of OpenVDB's class "level set": distances to a surface, negative inside.
  bool isLevelSet() const;
  /// Returns the text of a grid's metadata, such as "modality" (see VolumeInfo); empty where there is none.
  std::string metadata(const std::string& key) const;
  /// Returns the background of the grid that emits, 0 where it is not finite. @pre there is one
  float emissionBackground() const;
  /// @throw InvalidArgument  the transform is not affine
  glm::dmat4 indexToWorld() const;
  /// Returns the bounds of the centres of the active voxels, tiles included; empty for an empty grid.
  IndexBox activeBox() const;
  /// Returns the bounds in world space of the eight corners of activeBox().
  Box worldBounds() const;
};

}  // namespace umbrick
