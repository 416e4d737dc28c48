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
    std::string
        label;         // what readScalarGrid takes: the name, with "[k]" behind it when several share it or it is empty
    std::string type;  // "float", "vec3s", ...
    bool scalar = false;
  };
  std::vector<Row> grids;
  openvdb::MetaMap metadata;  // of the file
};
/// @throw IoError
GridListing listGrids(const std::filesystem::path& path);

}  // namespace umbrick
