// Volumes of any format as grids in memory, by the rules of conversions.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "umbrick/convert/convert_options.h"
#include "umbrick/convert/convert_report.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

struct LoadedVolume {
  ScalarGrid grid;
  ConvertedGrid report;
};

/// Converts a volume and keeps the grid in place of writing it. What is said of files that are written (`output`,
/// `verify`) is not looked at. Without build.background the grid has the value that most of the border of the volume
/// has, or the median of the border where no value stands out: beyond its voxels a picture sees what lies at its
/// border. A pipe can be read but once and has 0.
/// @throw OptionsError, InvalidArgument, IoError  as convertVolumes
LoadedVolume loadVolume(const std::filesystem::path& input, const ConvertOptions& options = {});

/// Converts a volume, or a grid of a file of grids, and keeps the grid that convert() would write, background included.
/// Of a file of several scalar grids it is the one that options.grids names, or else "density". `output`, `verify` and
/// `labels` are not looked at.
/// @throw OptionsError  as convert; several grids, and none is named
/// @throw InvalidArgument, IoError  as convert
LoadedVolume convertInMemory(const std::filesystem::path& input, const ConvertOptions& options = {});

/// What became of a grid that was saved.
struct SavedGrid {
  std::int64_t bytes = 0;          // that were written
  QuantiseError quantised;         // of a .nvdb whose values are packed
  std::vector<std::string> notes;  // what the format changes or does not hold, a line each without the name
};

/// Writes a grid that is in memory as conversions write theirs, whole or not at all.
/// @param type  of the voxels it was made of, in which a dense file stores them where it holds all values
/// @throw OptionsError  as checkOutput; a target  @throw InvalidArgument, IoError  as writeGrids, writeNanoVdb and
///                      writeDense
SavedGrid saveGrid(const ScalarGrid& grid, const std::filesystem::path& output, const OutputOptions& options = {},
                   std::optional<VoxelType> type = {});

}  // namespace umbrick
