// One scalar grid of a .vdb or .nvdb file.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

/// Reads a grid of a .vdb or .nvdb file.
/// @param selector  "name", or "name[1]" for the second grid of that name; when empty, the only scalar grid is read, or
///                  else the one called "density"
/// @throw IoError          the file is missing, a directory, truncated, corrupt or not a .vdb file
/// @throw InvalidArgument  there is no such grid (the message lists those there are), the grid is not scalar (the
///                         message names its type), or its transform is not affine (frustum)
ScalarGrid readScalarGrid(const std::filesystem::path& path, const std::string& selector = {});

/// Does the same but takes any transform. This is enough to copy a grid, but not to render it.
ScalarGrid readScalarGridAnyTransform(const std::filesystem::path& path, const std::string& selector);

}  // namespace umbrick
