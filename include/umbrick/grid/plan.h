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
  double share = 0.1;                                // of the layers that is read, but no fewer than 5
  std::int64_t wholeVoxels = std::int64_t(1) << 24;  // volumes up to so many are read as a whole
  VdbCodec codec = VdbCodec::blosc;                  // of the .vdb
};

/// `value` +- `uncertainty`, 95 % confidence; exact where that is 0.
struct Estimate {
  double value = 0, uncertainty = 0;
};

struct GridPlan {
  std::uint64_t voxels = 0, voxelsRead = 0;
  std::int64_t layers = 0, layersRead = 0;  // of 8 slices, as high as a leaf
  Estimate activeVoxels, leaves;
  Estimate gridBytes;   // of the grid in memory
  Estimate fileBytes;   // of the .vdb
  Estimate peakBytes;   // while it is converted: the grid and the slabs that it is made of; the program itself and what
                        // the format of the source needs come on top
  std::string storage;  // as in BuildReport
};

/// Builds the leaves of layers of 8 slices, evenly spaced over the volume, and packs some of them as a .vdb does; the
/// slices between are skipped. Nothing is kept.
///
/// The uncertainty comes from the differences between layers that follow each other, as is usual for a systematic
/// sample of n of N: t(n-1) N sqrt((1 - n/N) / n * mean of (y_k+1 - y_k)^2 / 2), Wolter 2007, Introduction to Variance
/// Estimation, ch. 8. Where no layer has anything, what fits between two of them is the uncertainty.
/// @throw InvalidArgument  as buildGrid; share outside (0, 1]
/// @throw IoError          as buildGrid
GridPlan planGrid(VoxelSource& source, const BuildOptions& options = {}, const PlanOptions& plan = {});

}  // namespace umbrick
