// What umbrick convert is asked for.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_line.h"
#include "umbrick/convert/convert_options.h"

namespace umbrick::tools {

struct ConvertCommand {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path output;
  ConvertOptions options;  // those that the program's options set as they are
  std::string codec;       // "blosc", "zip" or "none"; empty: not given
  std::string format;      // "vdb", "nvdb" or "nrrd", where the name of the output does not say; empty: not given
  std::string quantise;    // "4", "8", "16" or "n"; empty: not given
  std::vector<std::int64_t> dims;
  std::string type, endian = "little";
  std::int64_t headerBytes = 0;
  int bitsStored = 0, threads = 0;
  std::optional<std::array<double, 3>> spacing, origin;
  std::string target, up;                     // names of kTargets and kAxes, or empty
  std::string space;                          // "lps", "ras", "file", or empty
  std::string background;                     // "auto", a number, or empty
  std::optional<float> threshold;             // grid units
  std::optional<std::array<float, 2>> range;  // grid units
  std::string maskType = "u8";
  std::optional<std::array<int, 6>> crop;  // first and last voxel
  std::vector<double> resample;            // spacing, world units: none, one for all axes, or three
  std::optional<float> isosurface;         // grid units
  float halfWidth = 3;                     // voxels
  std::string frames;                      // which of a sequence; empty: all
  std::string component;                   // "all", or a word of chooseComponent; empty: not given
  std::optional<std::int64_t> frame;       // of a file of several volumes
  std::int64_t components = 1;             // of headerless raw
  std::string labels;                      // "all", or values and names with commas between; empty: not given
  bool plan = false, force = false;

  bool raw() const { return !dims.empty() || !type.empty(); }
};

/// Declares them. @param command  is filled when the program's arguments are parsed
void addConvertOptions(CLI::App& app, const std::shared_ptr<ConvertCommand>& command);

/// What options of several forms come to, as the library takes it.
/// @throw UsageError  they do not go together
ConvertOptions settledOptions(const ConvertCommand& command);

}  // namespace umbrick::tools
