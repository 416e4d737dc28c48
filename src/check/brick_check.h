// Checks invariants of bricks that need no picture.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "check/steps.h"
#include "umbrick/check/invariants.h"

namespace umbrick {

/// Compares voxels of aprons with those that the neighbours own, also of neighbours that are not stored: values, and
/// gradient magnitudes where there are any. Adds the number of voxels that differ.
/// @param most   number of bricks to look at: all, or so many chosen at random
/// @param steps  is told how far this is
/// @throw CheckStopped
void checkAprons(const Bricks& bricks, std::size_t most, unsigned seed, const CheckSteps& steps,
                 InvariantResult& result);

/// Adds the number of a brick's voxels, its apron included, that lie outside the range by which the brick is culled.
void checkRanges(const Bricks& bricks, std::size_t most, unsigned seed, const CheckSteps& steps,
                 InvariantResult& result);

}  // namespace umbrick
