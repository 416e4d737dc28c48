// What a .vdb file holds, told without reading voxels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "umbrick/grid/float_grid.h"

namespace umbrick {

struct GridListing {
  struct Row {
    /// What readScalarGrid takes: the name, with "[k]" behind it when several grids share the name or it is empty.
    std::string label;
    std::string type;  // "float", "vec3s", ...
    bool scalar = false;
  };
  std::vector<Row> grids;
  openvdb::MetaMap metadata;  // metadata of the file
};
/// @throw IoError  the file cannot be read
GridListing listGrids(const std::filesystem::path& path);

}  // namespace umbrick
