// What a conversion would make and need, from a part of the voxels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/vdb_codec.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

struct PlanOptions {
  double share = 0.1;                                // share of the layers that is read; at least 5 layers are
  std::int64_t wholeVoxels = std::int64_t(1) << 24;  // volumes of up to so many voxels are read as a whole
  VdbCodec codec = VdbCodec::blosc;                  // of the .vdb file
};

/// An estimate `value` +- `uncertainty` at 95 % confidence. It is exact where the uncertainty is 0.
struct Estimate {
  double value = 0, uncertainty = 0;
};

struct GridPlan {
  std::uint64_t voxels = 0, voxelsRead = 0;
  std::int64_t layers = 0, layersRead = 0;  // layers of 8 slices, as high as a leaf
  Estimate activeVoxels, leaves;
  Estimate gridBytes;  // of the grid in memory
  Estimate fileBytes;  // of the .vdb file
  /// Memory during the conversion, for the grid and the voxel slabs of which it is made. What the program itself
  /// and the format of the source need comes on top.
  Estimate peakBytes;
  std::string storage;  // as in BuildReport
};

/// Reads layers of 8 slices that are evenly spaced over the volume, and skips the slices between. It builds the leaves
/// of these layers, packs some of them as a .vdb file does, and keeps nothing.
///
/// The uncertainty comes from the differences between layers that follow each other, as is usual for a systematic
/// sample of n layers of N: t(n-1) N sqrt((1 - n/N) / n * mean of (y_k+1 - y_k)^2 / 2), Wolter 2007, Introduction to
/// Variance Estimation, ch. 8. Where no layer has anything, the uncertainty is what fits between two of them.
/// @throw InvalidArgument  as buildGrid; share outside (0, 1]
/// @throw IoError          as buildGrid
GridPlan planGrid(VoxelSource& source, const BuildOptions& options = {}, const PlanOptions& plan = {});

}  // namespace umbrick
