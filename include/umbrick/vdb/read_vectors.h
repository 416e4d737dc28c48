// Grids of vec3 of a .vdb file: whole, or as one number for each voxel.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openvdb/openvdb.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

/// Reads a grid of three floats, doubles or integers a voxel, as floats.
/// @param selector  "name" or "name[1]"
/// @param progress  as for readScalarGrid
/// @throw IoError          as readScalarGrid
/// @throw InvalidArgument  there is no such grid, or it is not one of vec3
openvdb::Vec3SGrid::Ptr readVectorGrid(const std::filesystem::path& path, const std::string& selector,
                                       const std::function<void(double share)>& progress = {});

/// Makes a grid of one number of each voxel of a grid of vec3.
/// @param component  0 to 2; nothing for the length of the vector
/// @throw InvalidArgument  another component, or a transform that is not affine
ScalarGrid vectorComponent(const openvdb::Vec3SGrid& grid, std::optional<int> component);

}  // namespace umbrick
