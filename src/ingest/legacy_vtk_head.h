// The text of a legacy VTK file up to the voxels, past whatever data stand before them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/ingest/list_arrays.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

struct LegacyHead {
  bool ascii = false, cells = false;
  std::array<std::int64_t, 3> points{};
  std::array<double, 3> origin{0, 0, 0}, spacing{1, 1, 1};
  VoxelType type = VoxelType::u8;
  std::string array;
  std::int64_t components = 1;
  VoxelMeaning meaning = VoxelMeaning::scalar;
  std::int64_t bytes = 0;             // where the voxels begin
  std::optional<double> time;         // of a field of the whole, which stands before the voxels
  std::optional<std::int64_t> cycle;  // the same: the number of the step
};

/// Reads up to the first array of one number for each point or cell, or to that of the name. What lies behind it is
/// left alone. Where the file has none, the first array of several numbers is taken.
/// @param name  of the array; empty: any
/// @throw IoError  no structured points, or no such array
LegacyHead readLegacyHead(const std::filesystem::path& path, const std::string& name);

/// Lists the arrays of the whole file.
std::vector<ArrayRow> listLegacyArrays(const std::filesystem::path& path);

}  // namespace umbrick
