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

}  // namespace umbrick
