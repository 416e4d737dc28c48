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
  std::string name = "density";          // name of the grid; only buildGrid uses it
  std::optional<float> background = {};  // grid units; by default that of the grid, or 0 for a dense volume
  /// Grid units. Voxels this close to the background are left out, and a leaf whose values lie this close to one value
  /// becomes a tile.
  float tolerance = 0;
  std::optional<float> clipBelow = {};  // grid units: voxels below this become background
  std::optional<float> clipAbove = {};  // grid units: voxels above this become background
  /// Rounds values to 16-bit floats and saves them as such. A grid that is marked for half floats is always so treated.
  bool half = false;
  /// Grid units. Values are rounded to multiples of it, which pack better, best if it is a power of two. 0: no steps.
  float step = 0;
  /// Grid units. Picks tolerance, step and half, in place of those given, so that no voxel is off by more. The storage
  /// is the first that holds this: exact half floats, half floats in steps, half floats, floats in steps, floats.
  std::optional<float> maxError = {};
  std::function<void(double)> progress = {};  // called now and then with the share that is done, 0 to 1; may be empty
};

/// The errors |source - stored| of the voxels looked at. Clipped voxels and those that are not finite count as 0.
struct Loss {
  double max = 0;  // grid units
  double rms = 0;  // grid units, over all voxels looked at; the squares of several parts add up
};

/// What a grid holds after it was built, and what was lost. The numbers are exact, not sampled.
struct BuildReport {
  std::uint64_t voxels = 0;        // voxels looked at: all of a dense volume, the active ones of a grid
  std::uint64_t activeVoxels = 0;  // active voxels of the result, those in tiles included
  std::uint64_t activeTiles = 0, leaves = 0;
  /// Grid units: the largest |source - stored| that tolerance, step and half cause, over voxels that are neither
  /// clipped nor NaN or infinite.
  double maxError = 0;
  double rmsError = 0;            // grid units: root mean square of the same errors, over all voxels looked at
  double activeRmsError = 0;      // grid units: the same over the active voxels of the result
  Loss tolerance, rounding;       // parts: of voxels left out or merged into tiles; of step and half
  Loss quantising;                // the part of a file that quantises (writeNanoVdb); a bound, added to the others
  std::string storage = "float";  // "float" or "half"; where there are steps, with ", steps of ..." behind it
  /// Grid units: the largest error of the conversion to 32-bit float, which comes first. Added to maxError it bounds
  /// the total error.
  double conversionError = 0;
  std::uint64_t clippedVoxels = 0;  // voxels below clipBelow or above clipAbove that were not background already
  double maxClipChange = 0;         // grid units: largest |source - background| among the clipped voxels
  std::uint64_t nonFinite = 0;      // NaN and infinite voxels, which are stored as background
  /// Grid units: |new - old| background of a grid, by which all that is outside changes.
  double backgroundChange = 0;
};

/// The errors |grid - file| of quantised values: of all values in leaves, also inactive ones, which are not exact
/// either. Tiles and the background are exact.
struct QuantiseError {
  double max = 0;                         // grid units
  double squares = 0, activeSquares = 0;  // sums of squares over all values in leaves, and over the active ones
};

/// Adds the errors of quantising to what was lost before. The sums bound both errors together.
/// @param activeOnly  the report is about the active voxels of a grid, not about all of a dense volume
void addQuantising(BuildReport& report, const QuantiseError& error, bool activeOnly);

struct BuiltGrid {
  openvdb::FloatGrid::Ptr grid;
  BuildReport report;
};

/// Reads a source to its end in voxel slabs and builds a fog volume whose transform is the source's indexToWorld.
/// Metadata is kept. Only active leaves stay in memory; they are built on all cores while the next voxel slab is read.
///
/// The losses are kept in the metadata of the grid, each where it is not 0: error_max and error_rms; the parts of
/// tolerance and of rounding (error_max_tolerance and so on); error_max_to_float, clipped_voxels, clipped_max_change
/// and storage. For a grid that had them already the sums are kept, which bound the errors since the first source.
/// @throw IoError          the source fails, or two of its voxel slabs are larger than the machine's memory
/// @throw InvalidArgument  tolerance, step or maxError is negative, a limit is not finite, half floats cannot hold all
///                         values, or OpenVDB refuses the transform (voxels of less than 3e-15 cubed world units)
BuiltGrid buildGrid(VoxelSource& source, const BuildOptions& options = {});

/// Does the same for a grid, whose class, transform and metadata stay. Active voxels and tiles are treated like the
/// voxels of a dense volume, but that without a tolerance those that have just the background stay active. Inactive
/// ones keep their value and state, except that those that hold the old background follow it. A level set is only
/// rounded to half, and only where that is asked for, since its surface needs the values on both sides of it.
/// @throw InvalidArgument  as buildGrid
BuiltGrid sparsifyGrid(const ScalarGrid& grid, const BuildOptions& options = {});

}  // namespace umbrick
