// Volumes on a lattice of other spacing, with the integral of their values kept.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// What resampling did, complete when the resampled source has been read to its end. Voxels of both volumes count
/// as boxes of one value, so the numbers are exact integrals over the volume, not samples. What is not finite
/// counts in none.
struct ResampleReport {
  glm::i64vec3 dimsBefore{0}, dimsAfter{0};
  glm::dvec3 spacing{0};  // spacing of the voxels after, world units along each axis
  double max = 0;         // largest |source - resampled|, grid units
  double rms = 0;         // root mean square of the same over the volume, grid units
  /// Integral of the value over the volume, grid units x world units cubed.
  double integralBefore = 0, integralAfter = 0;
};

/// Makes a volume whose voxels are `spacing` apart along its own axes. Each new voxel has the mean of what it covers of
/// the source: voxels of the source are boxes of one value and count with the part that is covered. This holds for
/// larger and smaller voxels alike.
///
/// Axes keep their directions, shear included, and the outer faces at the start of the axes stay where they are.
/// There are as many voxels as it takes to cover the volume; the last ones may reach beyond it and have the mean of
/// their part inside. Headers of few digits may miss whole voxels by a rounding: where whole voxels fill the volume
/// up to a thousandth of one, they count as filling it. A value that is not finite makes each voxel that covers some
/// of it not finite.
///
/// In memory there are one slice of either volume and what the source reads at once, which is 16 MiB or a slice.
/// @param spacing  world units
/// @param report   is filled while slices are read, if not null
/// @throw InvalidArgument  spacing not positive and finite, or more than 2^31 - 1 voxels along an axis
std::unique_ptr<VoxelSource> resampleSource(std::unique_ptr<VoxelSource> source, const glm::dvec3& spacing,
                                            std::shared_ptr<ResampleReport> report = nullptr);

}  // namespace umbrick
