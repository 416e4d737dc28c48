// Checks invariants of single slices, by what each pixel samples.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/atlas/resident_volume.h"
#include "umbrick/check/invariants.h"

namespace umbrick {

struct SliceCheckOptions {
  int slices = 24;              // number of slices, spread over the sweep
  double samplerPrecision = 0;  // voxels
  bool complete = false;        // whether every cell of the domain is drawn, not only those that hold something
};

struct SliceResults {
  InvariantResult *gaps, *doubleHits;  // number of pixels
  InvariantResult* values;  // displacement of samples that explains the differences, voxels; null: not compared
};

/// Draws slices of a view without culling and compares, pixel by pixel, the number of bricks that shade it with the
/// lattice cell that its sample lies in, and the value with OpenVDB's BoxSampler at the same world point.
/// @param scene  its medium, clipping and near distance do not matter
void checkSlices(ResidentVolume& resident, const ScalarGrid& grid, const ResolvedScene& scene, const std::string& view,
                 const SliceCheckOptions& options, const SliceResults& results);

}  // namespace umbrick
