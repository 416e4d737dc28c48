// Level sets in the place of grids that umbrick convert built.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/isosurface.h"

namespace umbrick::tools {

/// Puts the level set of a grid in its place.
/// @param input  for messages  @throw InvalidArgument  as makeIsosurface
IsosurfaceReport replaceByIsosurface(const std::filesystem::path& input, const IsosurfaceOptions& options,
                                     BuiltGrid& built);

/// On stdout.
void printIsosurface(const std::string& label, float value, const IsosurfaceReport& report);

}  // namespace umbrick::tools
