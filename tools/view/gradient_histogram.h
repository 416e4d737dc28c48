// How often values and gradient magnitudes meet in a grid.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "umbrick/grid/scalar_grid.h"

namespace umbrick::view {

struct GradientHistogram {
  int values = 128, gradients = 64;  // bins
  double low = 0, high = 1;          // of the values, grid units
  double most =
      1;  // of the gradient magnitudes, which begin at 0; grid units per world unit, as a 2D function has them
  std::vector<double> counts;  // values x gradients, value fastest; what lies beyond is in the outer bins
};

/// Looks at active voxels: at all, or at those of every n-th leaf where there are more than a million. The gradient is
/// that of bricks: central differences of neighbouring voxels. `most` is what one voxel in two thousand exceeds.
/// @param low,high  low < high
GradientHistogram surveyGradients(const ScalarGrid& grid, double low, double high);

}  // namespace umbrick::view
