// Which way a grid stands in the world: up, and the way it faces.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "umbrick/core/axis.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

struct Orientation {
  Axis up = Axis::z;
  Axis front = Axis::minusY;
  /// Whether the file states where left, front and head of a patient are: front is then anterior and up superior.
  bool anatomy = false;
  /// Whether the patient's left lies at azimuth -90 and not at 90: in spaces such as LAS, which are left-handed.
  bool mirrored = false;
  std::string reason;  // in words: "y is up in most files of grids"
};

/// Tells which way a grid stands. The anatomy counts where the metadata "space" states it (NIfTI: RAS, DICOM: LPS).
/// Volumes of other scanners and simulations stand with z up. A file of grids that another program wrote says nothing:
/// there y is up, as in the programs that make most of them, unless the grid is taller along z or Blender wrote it.
/// @param foreign  the grid comes from a file of grids
/// @param creator  what that file says of the program that wrote it; may be empty
Orientation orientationOf(const ScalarGrid& grid, bool foreign = false, const std::string& creator = {});

}  // namespace umbrick
