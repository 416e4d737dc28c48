// What convert writes: the format by the extension of the output.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/grid/build_grid.h"

namespace umbrick::tools {

struct GridOutput {
  std::filesystem::path path;  // .vdb, .nvdb, .mhd or .nrrd
  std::string codec;           // of a .vdb: "blosc", "zip" or "none"; empty: blosc
};

/// To be asked before anything is read.
/// @throw UsageError  another extension, a codec for another format than .vdb, several inputs for a format that holds
///                    one grid, or an output that would take the place of an input
void checkOutput(const GridOutput& output, const std::vector<std::filesystem::path>& inputs);

/// @param type  of the voxels of the source, for the dense formats
/// @return bytes written
/// @throw UsageError  several grids for a format that holds one  @throw Error  as the writers do
std::int64_t writeOutput(const GridOutput& output, const std::vector<openvdb::FloatGrid::ConstPtr>& grids,
                         openvdb::MetaMap metadata, std::optional<VoxelType> type);

}  // namespace umbrick::tools
