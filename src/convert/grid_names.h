// Names of the grids that several volumes become, and numbers of those of frames.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openvdb/Grid.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "umbrick/convert/convert_options.h"

namespace umbrick {

/// One name for each input: options.names where there are any, else the stems of the file names, without the ending of
/// a packing: "head" for scans/head.nii.gz. One input alone is build.name.
/// @throw OptionsError  another number of names than inputs, or two that are equal
std::vector<std::string> gridNames(const std::vector<std::filesystem::path>& inputs, const ConvertOptions& options);

/// One unit for each input: one that is given is for all of them, none gives empty strings.
/// @throw OptionsError  neither 0, 1 nor as many as inputs
std::vector<std::string> gridUnits(std::size_t inputs, const std::vector<std::string>& given);

/// Keeps the number of a frame as metadata `frame` of a grid that has none.
void numberGrid(openvdb::GridBase& grid, std::int64_t number);

}  // namespace umbrick
