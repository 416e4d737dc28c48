// Whether a file holds grids or a volume.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "umbrick/convert/convert_options.h"

namespace umbrick {

/// Returns true for a .vdb or .nvdb, told by its name, or else by its first bytes.
bool holdsGrids(const std::filesystem::path& path);

/// Returns true where the input is a file of grids, false where all inputs are volumes. With source.open.raw or
/// source.open.array all inputs are volumes.
/// @throw OptionsError  there are several inputs, and one of them is a file of grids
bool holdGrids(const std::vector<std::filesystem::path>& inputs, const SourceOptions& source);

}  // namespace umbrick
