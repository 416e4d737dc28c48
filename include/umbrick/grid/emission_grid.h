// A second grid beside the first: what emits light, on the lattice of what scatters it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

/// How a second grid came onto the lattice of the first.
struct EmissionReport {
  bool resampled = false;  // false: it lies there to a thousandth of a voxel, and its voxels are taken as they are
  /// Of a resampled one: the largest |stored - interpolated on the new lattice| at its active voxels, and the root of
  /// the mean of its square, grid units.
  double max = 0, rms = 0;
};

/// Sets first.emission to the values of the second grid: to the grid itself where both transforms are the same, else to
/// a trilinear resampling (openvdb::tools::resampleToMatch).
/// @throw InvalidArgument  a transform is not affine
EmissionReport addEmission(ScalarGrid& first, const ScalarGrid& second);

}  // namespace umbrick
