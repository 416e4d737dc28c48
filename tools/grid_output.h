// What convert writes: the format by the extension of the output.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/grid/build_grid.h"
#include "umbrick/vdb/write_volume.h"

namespace umbrick::tools {

struct GridOutput {
  std::filesystem::path path;  // .vdb, .nvdb, .mhd or .nrrd
  std::string codec;           // of a .vdb: "blosc", "zip" or "none"; empty: blosc
  std::string quantise;        // of a .nvdb: "4", "8", "16" or "n"; empty: 32-bit floats
  float quantiseError = 0;     // at most, of "n", grid units
};

/// What codec names; blosc where it is empty.
VdbCodec codecOf(const GridOutput& output);

/// To be asked before anything is read.
/// @throw UsageError  another extension, a codec for another format than .vdb, quantised values for another one than
///                    .nvdb, several inputs for a format that holds one grid, or an output that would take the place of
///                    an input
void checkOutput(const GridOutput& output, const std::vector<std::filesystem::path>& inputs);

/// @param type   of the voxels of the source, for the dense formats
/// @param check  is given the file before it takes its name, and the errors of grids that are quantised, else none
/// @return bytes written
/// @throw UsageError  several grids for a format that holds one  @throw Error  as the writers do
std::int64_t writeOutput(const GridOutput& output, const std::vector<openvdb::FloatGrid::ConstPtr>& grids,
                         openvdb::MetaMap metadata, std::optional<VoxelType> type, const NanoCheck& check);

}  // namespace umbrick::tools
