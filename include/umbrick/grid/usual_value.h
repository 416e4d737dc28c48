// A value that most of a grid has: what a better background would leave out.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "umbrick/grid/float_grid.h"

namespace umbrick {

struct UsualValue {
  float value = 0;           // grid units
  std::uint64_t voxels = 0;  // active ones that have it, those in tiles included
};

/// Finds the value that more than half of the active voxels have, with the majority vote of Boyer and Moore ("MJRTY",
/// 1991): one pass finds the only candidate and another one counts it, on all cores. Nothing where there is none, for
/// which a sixteenth of a large grid is enough.
std::optional<UsualValue> usualValue(const openvdb::FloatGrid& grid);

/// Returns the most frequent value on the six faces of the box of the active voxels, of some thousand that lie evenly
/// there, grid units. Nothing where less than a tenth of them have it, as in fields that vary everywhere, or where no
/// voxel is active.
std::optional<float> usualBorder(const openvdb::FloatGrid& grid);

}  // namespace umbrick
