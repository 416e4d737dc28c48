// Invariants of bricks that need no picture.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/check/invariants.h"

namespace umbrick {

/// Voxels of aprons against those that the neighbours own, also of neighbours that are not stored: values, and gradient
/// magnitudes where there are any. Adds the voxels that differ.
/// @param most  bricks to look at: all, or as many chosen at random
void checkAprons(const Bricks& bricks, std::size_t most, unsigned seed, InvariantResult& result);

/// Voxels of a brick, its apron included, that lie outside the range by which it is culled. Adds their number.
void checkRanges(const Bricks& bricks, std::size_t most, unsigned seed, InvariantResult& result);

}  // namespace umbrick
