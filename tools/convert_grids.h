// Grids of a .vdb or .nvdb to a file of their own, with the loss it cost.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "convert_sequence.h"
#include "grid_output.h"
#include "umbrick/core/box.h"
#include "umbrick/grid/isosurface.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick::tools {

struct GridInput {
  std::filesystem::path path;
  std::optional<std::string> grid;  // which one; else all scalar ones
  BuildOptions build;
  std::function<ScalarGrid()> mask;  // opens it; empty where there is none
  std::optional<IndexBox> crop;
  bool verify = false;
  std::optional<IsosurfaceOptions> isosurface;
};

/// How a conversion went.
struct Outcome {
  std::int64_t bytesIn = 0, bytesOut = 0;
};

/// By its name or its first bytes.
bool holdsGrids(const std::filesystem::path& path);

/// Writes them and prints what was lost. @throw UsageError  @throw Error  as the readers and writers do
Outcome convertGrids(const GridInput& input, const GridOutput& output);

/// One file for each frame, told in one line. The next one is read while the grids of one are made sparse and written.
/// @param input   of a frame, given its place in the sequence
Outcome convertGridFrames(const std::vector<FrameFiles>& frames, const GridOutput& output,
                          const std::function<GridInput(std::size_t)>& input, ProgressBar& bar);

}  // namespace umbrick::tools
