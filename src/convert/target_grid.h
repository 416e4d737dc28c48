// Grids made ready for another program.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "umbrick/convert/convert_options.h"
#include "umbrick/convert/convert_report.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {

/// How values are found again: value = low + stored * (high - low).
struct ValueMap {
  double low = 0, high = 1;  // grid units
};

/// Whether the values of fogs are mapped to 0..1 for a target.
bool mapsValues(const ConvertOptions& options);

/// Leaves out what lies below the background, which would be below the 0 of a target.
void leaveOutBelow(float background, BuildOptions& build);

/// Changes place, values and metadata of a converted grid to what the target expects, and tells in its report what that
/// is and what it costs. The inverse of the map of values is kept as metadata value_low and value_high, in
/// value_range_unit. A level set keeps its surface: distances follow the unit of length. Half floats are not taken
/// where more would be lost than options.build.maxError.
/// @param foreign  it comes from a file of grids
/// @return how the values are found again, where they were mapped
std::optional<ValueMap> prepareFor(const ConvertOptions& options, bool foreign, openvdb::FloatGrid& grid,
                                   ConvertedGrid& report);

/// Does the same for the grid of a label, whose shares from 0 to 1 become half floats and keep their name.
void prepareLabel(const ConvertOptions& options, openvdb::FloatGrid& grid, ConvertedGrid& report);

/// Gives the one grid of a file, or the first of several, the name under which the target looks for a density, unless a
/// grid has it.
/// @return a line that says so, or nothing
std::string nameFor(Target target, const std::vector<openvdb::FloatGrid*>& grids);

/// Returns a grid as it was before its values were mapped, up to rounding.
openvdb::FloatGrid::ConstPtr unmapped(const openvdb::FloatGrid::ConstPtr& grid, const std::optional<ValueMap>& map);

}  // namespace umbrick
