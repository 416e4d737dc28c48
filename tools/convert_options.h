// What umbrick convert is asked for.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grid_output.h"
#include "progress.h"
#include "umbrick/core/box.h"
#include "umbrick/grid/build_grid.h"

namespace umbrick::tools {

struct ConvertOptions {
  std::vector<std::filesystem::path> inputs;
  std::vector<std::string> names, units;  // of the grids, given by the user
  std::filesystem::path input;            // the one at hand
  GridOutput output;
  std::string unit;  // of its values
  BuildOptions build;
  std::string gridName, series;
  bool allGrids = true, verify = false;
  std::vector<std::int64_t> dims;
  std::string type, endian = "little";
  std::int64_t headerBytes = 0;
  int bitsStored = 0, threads = 0;
  std::array<double, 3> spacing{1, 1, 1}, origin{0, 0, 0};
  bool hasSpacing = false, hasOrigin = false;
  std::string background;                     // "auto", a number, or empty
  std::optional<float> threshold;             // grid units
  std::optional<std::array<float, 2>> range;  // grid units
  std::filesystem::path mask;
  std::string maskType = "u8";
  std::optional<std::array<int, 6>> crop;  // first and last voxel
  std::vector<double> resample;            // spacing, world units: none, one for all axes, or three
  std::optional<float> isosurface;         // grid units
  float halfWidth = 3;                     // voxels
  std::string frames;                      // which of a sequence; empty: all
  bool plan = false;
  ProgressBar* bar = nullptr;

  bool raw() const { return !dims.empty() || !type.empty(); }
};

/// Declares them. @param options  is filled when the program's arguments are parsed
void addConvertOptions(CLI::App& command, const std::shared_ptr<ConvertOptions>& options);

/// What options of several forms come to, and whether they go together.
/// @throw UsageError
void settleOptions(ConvertOptions& options);

/// @pre options.crop
IndexBox cropBox(const ConvertOptions& options);

}  // namespace umbrick::tools
