// Level sets in the place of grids that a conversion built.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/isosurface.h"

namespace umbrick {

/// Puts the level set of a grid in its place.
/// @param input  for messages  @throw InvalidArgument  as makeIsosurface
IsosurfaceReport replaceByIsosurface(const std::filesystem::path& input, const IsosurfaceOptions& options,
                                     BuiltGrid& built);

}  // namespace umbrick
