// How a conversion went: what each grid holds and what was lost.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/isosurface.h"
#include "umbrick/grid/resample.h"
#include "umbrick/grid/source_filters.h"
#include "umbrick/grid/usual_value.h"
#include "umbrick/grid/verify.h"

namespace umbrick {

/// A grid that was written. What was not asked for is not there.
struct ConvertedGrid {
  std::filesystem::path input;
  std::string label;  // name of the grid, with "[k]" behind it where several of an input file share it
  std::optional<VoxelType> volumeType;  // of the voxels as the input stores them; none where it was a grid
  std::vector<std::string> notes;       // of the volume, as VolumeInfo has them, or of a grid whose world was changed
  std::optional<VolumeLabel> volumeLabel;  // whose voxels the grid shows, of a volume of labels
  BuildReport build;
  std::optional<BorderMode> background;  // what the border of the volume had
  /// Of a volume more than half of which is active: the value that more than half of all its voxels have, which as a
  /// background would leave them out.
  std::optional<UsualValue> usual;
  /// Of a volume nearly all of which is active: the usual value of its border, if there is one, grid units.
  std::optional<float> border;
  std::optional<std::uint64_t> masked;  // voxels that the mask made background
  std::optional<ResampleReport> resampled;
  std::optional<IsosurfaceReport> isosurface;
  std::optional<VerifyReport> verified;
  /// True for a grid that is a level set where a background, a tolerance or limits were asked for, which do not apply
  /// to a level set.
  bool keptLevelSet = false;
};

/// A grid of the input file that was not converted, since it is not scalar.
struct LeftOutGrid {
  std::string label, type;
};

/// A file that was written.
struct ConvertReport {
  std::filesystem::path output;
  std::vector<ConvertedGrid> grids;  // in the order in which they were written
  std::vector<LeftOutGrid> leftOut;
  std::vector<std::string> notes;  // of the file that was written, a line each without its name
  std::int64_t bytesIn = 0;        // of the files that hold the inputs, packed as they are
  std::int64_t bytesOut = 0;       // of the files that were written
};

}  // namespace umbrick
