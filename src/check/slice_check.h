// Checks invariants of single slices, by what each pixel samples.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "umbrick/atlas/resident_volume.h"
#include "umbrick/check/invariants.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick {

struct SliceResults {
  InvariantResult *gaps, *doubleHits;  // number of pixels
  InvariantResult* values;  // displacement of samples that explains the differences, voxels; null: not compared
};

/// Draws slices of views without culling and compares, pixel by pixel, the number of bricks that shade it with the
/// lattice cell that its sample lies in, and the value with OpenVDB's BoxSampler at the same world point.
class SliceChecker {
 public:
  /// @param slices            of each view, spread over the sweep
  /// @param samplerPrecision  voxels
  /// @param resident,grid     outlive this
  SliceChecker(ResidentVolume& resident, const ScalarGrid& grid, int slices, double samplerPrecision)
      : resident_(resident), grid_(grid), slices_(slices), samplerPrecision_(samplerPrecision) {}

  /// @param scene     its medium, clipping and near distance do not matter
  /// @param complete  whether every cell of the domain is drawn, not only those that hold something
  /// @param progress  is told the share that is done, before each slice, and may throw
  void check(const ResolvedScene& scene, const std::string& view, bool complete, const SliceResults& results,
             const std::function<void(double share)>& progress);

 private:
  ResidentVolume& resident_;
  const ScalarGrid& grid_;
  int slices_;
  double samplerPrecision_;
  std::optional<SliceRenderer> renderer_;
};

}  // namespace umbrick
