// Invariants of single slices, by what each pixel samples.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/atlas/resident_volume.h"
#include "umbrick/check/invariants.h"

namespace umbrick {

struct SliceCheckOptions {
  int slices = 24;              // spread over the sweep
  double samplerPrecision = 0;  // voxels
  bool complete = false;        // every cell of the domain is drawn, not only those that hold something
};

struct SliceResults {
  InvariantResult *gaps, *doubleHits;  // pixels
  InvariantResult* values;  // null: not compared. Displacement of samples that explains the differences, voxels
};

/// Draws slices of a view without culling and compares, pixel by pixel, the number of bricks that shade it with the
/// lattice cell that its sample lies in, and the value with OpenVDB's BoxSampler at the same world point.
/// @param scene  its medium, clipping and near distance are of no account
void checkSlices(ResidentVolume& resident, const ScalarGrid& grid, const ResolvedScene& scene, const std::string& view,
                 const SliceCheckOptions& options, const SliceResults& results);

}  // namespace umbrick
