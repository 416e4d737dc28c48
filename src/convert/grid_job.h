// One file of grids on its way to another: read, made sparse, written, verified.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "umbrick/convert/convert_options.h"
#include "umbrick/convert/convert_report.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/vdb/grid_listing.h"

namespace umbrick {

/// A file and its grids.
struct GridJob {
  std::optional<std::int64_t> frame;  // of a sequence: its number, which the grids keep
  std::filesystem::path input;
  ConvertOptions options;
  GridListing listing;
  std::optional<ScalarGrid> mask;
  ConvertReport report;           // has a row for each grid that is converted, which is filled step by step
  std::vector<ScalarGrid> grids;  // those that are read already, in the order of the report
};

/// Lists the grids and opens the mask.
/// @param options  settled  @throw OptionsError  options that are for volumes  @throw InvalidArgument  no scalar grid
GridJob openGridJob(const std::filesystem::path& input, const ConvertOptions& options);

/// Reads the grids ahead of writeGridJob, which else reads one after the other.
void readGrids(GridJob& job);

/// Makes a grid of the job sparse, and a level set of it where that is asked for. @param i  its row in the report
openvdb::FloatGrid::Ptr buildJobGrid(GridJob& job, std::size_t i, const BuildOptions& options);

/// Makes the grids sparse and writes them; verifies the file before it takes its name where that is asked for.
ConvertReport writeGridJob(GridJob& job, const std::filesystem::path& output);

}  // namespace umbrick
