// Volumes on a lattice of other spacing, with the integral of their values kept.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// What resampling did; complete when the resampled source has been read to its end. Voxels of both volumes count as
/// boxes of one value, so the numbers are exact integrals over the volume, not samples. What is not finite counts in
/// none.
struct ResampleReport {
  glm::i64vec3 dimsBefore{0}, dimsAfter{0};
  glm::dvec3 spacing{0};                         // of the voxels after, world units along each axis
  double max = 0;                                // largest |source - resampled|, grid units
  double rms = 0;                                // over the volume, grid units
  double integralBefore = 0, integralAfter = 0;  // of value over volume, grid units x world units cubed
};

/// A volume whose voxels are `spacing` apart along its own axes. Each new voxel has the mean of what it covers of the
/// source: voxels of the source are boxes of one value and count with the part that is covered, for larger and smaller
/// voxels alike.
///
/// Axes keep their directions, shear included, and the outer faces at the start of the axes stay where they are. There
/// are as many voxels as it takes to cover the volume: the last ones may reach beyond it and have the mean of their
/// part inside. Where whole voxels fill the volume up to a thousandth of one, as headers of few digits make it, they
/// count as filling it. A value that is not finite makes each voxel that covers some of it not finite.
///
/// Holds one slice of either volume and what the source reads at once, 16 MiB or a slice.
/// @param spacing  world units
/// @param report   if not null, is filled while slices are read
/// @throw InvalidArgument  spacing not positive and finite, or more than 2^31 - 1 voxels along an axis
std::unique_ptr<VoxelSource> resampleSource(std::unique_ptr<VoxelSource> source, const glm::dvec3& spacing,
                                            std::shared_ptr<ResampleReport> report = nullptr);

}  // namespace umbrick
