// One scalar grid of a .vdb or .nvdb file.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

/// Reads a grid of a .vdb or .nvdb file.
/// @param selector  empty: the only scalar grid, or else the one called "density"; "name"; "name[1]": the second of
///                  that name
/// @throw IoError          missing, a directory, truncated, corrupt or not a .vdb file
/// @throw InvalidArgument  no such grid (lists those there are), not a scalar grid (names its type), or a transform
///                         that is not affine (frustum)
ScalarGrid readScalarGrid(const std::filesystem::path& path, const std::string& selector = {});

/// As readScalarGrid, but takes any transform: to copy a grid, not to render it.
ScalarGrid readScalarGridAnyTransform(const std::filesystem::path& path, const std::string& selector);

}  // namespace umbrick
