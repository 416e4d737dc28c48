// What umbrick info says of the grids of a .vdb or .nvdb file.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace umbrick::tools {

/// Prints it to stdout.
/// @param only  labels of the grids to tell of; empty: all
/// @throw InvalidArgument  there is no such grid
void printGridInfo(const std::filesystem::path& file, const std::vector<std::string>& only, int bins, bool json);

}  // namespace umbrick::tools
