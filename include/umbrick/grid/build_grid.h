// Dense volumes and dense-ish grids to sparse grids, with the error that it costs.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "umbrick/grid/float_grid.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

struct BuildOptions {
  std::string name = "density";          // of the grid, buildGrid only
  std::optional<float> background = {};  // value of what is left out; else 0, or what the grid has
  float tolerance = 0;  // grid units: voxels this close to the background are left out, and leaves whose
                        // values lie this close to one value become a tile
  std::optional<float> clipBelow = {};  // grid units: voxels below become background
  std::optional<float> clipAbove = {};  // grid units: voxels above become background
  bool half = false;  // round to 16-bit floats and save as such; so is a grid that is so marked already
  float step = 0;     // grid units: round values to multiples of it, which pack better (best if a power of two); 0: not
  std::optional<float> maxError = {};  // grid units: picks tolerance, step and half so that no voxel is off by more,
                                       // in place of those three: exact half floats, half floats in steps, half
                                       // floats, floats in steps, or floats, whichever is the first that holds it
  std::function<void(double)> progress = {};  // called now and then with the share done, 0 to 1; may be empty
};

/// |source - stored| of the voxels looked at; voxels clipped and not finite count as 0.
struct Loss {
  double max = 0;  // grid units
  double rms = 0;  // grid units, over all voxels looked at: the squares of the steps add up
};

/// What a grid holds after it was built, and what was lost. Exact, not sampled.
struct BuildReport {
  std::uint64_t voxels = 0;        // looked at: all of a dense volume, the active ones of a grid
  std::uint64_t activeVoxels = 0;  // after; those in tiles included
  std::uint64_t activeTiles = 0, leaves = 0;
  double maxError = 0;        // largest |source - stored| by tolerance, step and half, of voxels neither clipped nor
                              // NaN/Inf
  double rmsError = 0;        // root of the mean square of the same, over all voxels looked at
  double activeRmsError = 0;  // over the voxels that are active after
  Loss tolerance, rounding;   // parts of it: left out or merged; step and half
  Loss quantising;            // part of it, added to the others as a bound: by a file that quantises (writeNanoVdb)
  std::string storage = "float";  // "float" or "half", with ", steps of ..." behind it
  double conversionError = 0;  // largest error of the step to 32-bit float, before; add both for a bound of the total
  std::uint64_t clippedVoxels = 0;  // below clipBelow or above clipAbove, and not background already
  double maxClipChange = 0;         // largest |source - background| among them
  std::uint64_t nonFinite = 0;      // NaN and infinite voxels, stored as background
  double backgroundChange = 0;      // |new - old| background of a grid: what the outside changes by
};

/// |grid - file| of what was quantised: all values of leaves, inactive ones too, which are not exact either. Tiles and
/// background are.
struct QuantiseError {
  double max = 0;                         // grid units
  double squares = 0, activeSquares = 0;  // sums: of all values in leaves, of the active ones
};

/// Adds that to what was lost before: the sums bound both errors.
/// @param activeOnly  the report is about the active voxels of a grid, not about all of a dense volume
void addQuantising(BuildReport& report, const QuantiseError& error, bool activeOnly);

struct BuiltGrid {
  openvdb::FloatGrid::Ptr grid;
  BuildReport report;
};

/// Reads a source to its end, slab by slab: only active leaves stay in memory. A fog volume whose transform is the
/// source's indexToWorld; metadata is kept. Leaves are built on all cores while the next slab is read.
///
/// The losses are kept in the metadata of the grid: error_max and error_rms, of tolerance and rounding apart
/// (error_max_tolerance, ...), error_max_to_float, clipped_voxels, clipped_max_change and storage, each where it is not
/// 0. For a grid that had them already the sums are kept, which bound the errors since the first source.
/// @throw IoError          the source fails, or two of its slabs are larger than the machine's memory
/// @throw InvalidArgument  tolerance, step or maxError negative, a limit not finite, values that half floats cannot
/// hold, or a transform
///                         that OpenVDB refuses (voxels of less than 3e-15 cubed world units)
BuiltGrid buildGrid(VoxelSource& source, const BuildOptions& options = {});

/// The same for a grid: class, transform and metadata stay. Active voxels and tiles are treated like the voxels of a
/// dense volume; inactive ones keep their value and state, except that those that hold the old background follow it.
/// A level set is only rounded to half where that is asked for: its surface stands and falls with both sides of it.
/// @throw InvalidArgument  as above
BuiltGrid sparsifyGrid(const ScalarGrid& grid, const BuildOptions& options = {});

}  // namespace umbrick
