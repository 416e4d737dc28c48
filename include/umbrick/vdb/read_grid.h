// One scalar grid of a .vdb or .nvdb file.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "umbrick/core/error.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

/// A file has several scalar grids, and none was named.
struct SeveralGrids : InvalidArgument {
  using InvalidArgument::InvalidArgument;
};

/// A grid of vec3 was found where one of single numbers is read: see read_vectors.h.
struct VectorGridFound : InvalidArgument {
  using InvalidArgument::InvalidArgument;
};

/// Reads a grid of a .vdb or .nvdb file.
/// @param selector  "name", or "name[1]" for the second grid of that name; when empty, the only scalar grid is read, or
///                  else the one called "density"
/// @param progress  may be empty; is called now and then while a .vdb is read, with the share of the grid's bytes that
///                  is done, in [0, 1]. What it throws ends the reading.
/// @throw IoError          the file is missing, a directory, truncated, corrupt or not a .vdb file
/// @throw SeveralGrids     there is none to choose without a selector (the message lists those there are)
/// @throw VectorGridFound  the grid is one of vec3, or the file has no others
/// @throw InvalidArgument  there is no such grid (the message lists those there are), the grid is not scalar (the
///                         message names its type), or its transform is not affine (frustum)
ScalarGrid readScalarGrid(const std::filesystem::path& path, const std::string& selector = {},
                          const std::function<void(double share)>& progress = {});

/// Does the same but takes any transform. This is enough to copy a grid, but not to render it.
ScalarGrid readScalarGridAnyTransform(const std::filesystem::path& path, const std::string& selector);

}  // namespace umbrick
