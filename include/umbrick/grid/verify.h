// Whether a grid holds what its source holds, voxel by voxel.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openvdb/openvdb.h>

#include <cstdint>

#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// What was found, to be compared with the BuildReport of the same source.
struct VerifyReport {
  std::uint64_t voxels = 0;   // voxels compared: all of a dense source, the active ones of a grid
  Loss error;                 // |source - grid|; clipped voxels and those that are not finite count as 0
  std::uint64_t wrongly = 0;  // voxels clipped or not finite that are not background in the grid
  std::uint64_t beyond = 0;   // active voxels of the grid beyond the source
  /// Returns true when nothing is worse than stated. The mean is compared up to the rounding of its sum.
  bool honours(const BuildReport& stated) const;
};

/// Reads the source to its end and compares. The grid may come from a file; only its values are compared
/// with the source.
/// @param options          background and limits that the grid was built with
/// @param backgroundError  largest error of the background where it lies in leaves, as in a quantised NanoVDB grid
/// @throw IoError  the source fails
VerifyReport verifyGrid(VoxelSource& source, const openvdb::FloatGrid& grid, const BuildOptions& options,
                        double backgroundError = 0);

/// Does the same for a grid that sparsifyGrid made of another one, whose active voxels are compared.
VerifyReport verifyGrid(const ScalarGrid& source, const openvdb::FloatGrid& grid, const BuildOptions& options,
                        double backgroundError = 0);

}  // namespace umbrick
