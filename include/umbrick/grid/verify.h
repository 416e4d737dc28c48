// Whether a grid holds what its source holds, voxel by voxel.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openvdb/openvdb.h>

#include <cstdint>

#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// What was seen, to be compared with the BuildReport of the same source.
struct VerifyReport {
  std::uint64_t voxels = 0;   // compared: all of the source, of a grid the active ones
  Loss error;                 // |source - grid|; voxels clipped and not finite count as 0
  std::uint64_t wrongly = 0;  // voxels clipped or not finite that are not background
  std::uint64_t beyond = 0;   // active voxels of the grid beyond the source
  /// Nothing is worse than stated. The mean is compared up to the rounding of its sum.
  bool honours(const BuildReport& stated) const;
};

/// Reads the source to its end. The grid may come from a file: it is told from the source by its values alone.
/// @param options          background and limits that the grid was built with
/// @param backgroundError  that the grid's background may have where it lies in leaves, as in a quantised NanoVDB grid
/// @throw IoError  the source fails
VerifyReport verifyGrid(VoxelSource& source, const openvdb::FloatGrid& grid, const BuildOptions& options,
                        double backgroundError = 0);

/// The same for a grid that sparsifyGrid made of another one: its active voxels are compared.
VerifyReport verifyGrid(const ScalarGrid& source, const openvdb::FloatGrid& grid, const BuildOptions& options,
                        double backgroundError = 0);

}  // namespace umbrick
