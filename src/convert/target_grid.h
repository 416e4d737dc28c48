// Grids made ready for another program.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "umbrick/convert/output_options.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {

/// How values are found again: value = low + stored * (high - low).
struct ValueMap {
  double low = 0, high = 1;  // grid units
};

/// What was done to a grid.
struct TargetChange {
  std::optional<ValueMap> map;
  bool half = false;    // values are saved as half floats, which they were not before
  QuantiseError error;  // of mapping and of half floats, grid units before
  std::vector<std::string> notes;
};

/// Changes place, values and metadata of a grid to what the target expects. The inverse of the map of values is kept as
/// metadata value_low and value_high, in value_range_unit. A level set keeps its surface: distances follow the unit of
/// length.
/// @param foreign   it comes from a file of grids
/// @param maxError  what may be lost in all, with what is lost already; half floats are not taken where they would lose
///                  more
TargetChange prepareFor(const OutputOptions& output, bool foreign, std::optional<double> maxError,
                        openvdb::FloatGrid& grid);

/// Gives the one grid of a file, or the first of several, the name under which the target looks for a density, unless a
/// grid has it.
/// @return a line that says so, or nothing
std::string nameFor(Target target, const std::vector<openvdb::FloatGrid*>& grids);

/// Returns a grid as it was before its values were mapped, up to rounding.
openvdb::FloatGrid::ConstPtr unmapped(const openvdb::FloatGrid::ConstPtr& grid, const std::optional<ValueMap>& map);

}  // namespace umbrick
