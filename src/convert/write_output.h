// Grids to a file of the format that its extension names.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/convert/output_options.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/vdb/write_volume.h"

namespace umbrick {

/// Refuses several grids for a format that holds one. @throw OptionsError  names some of them
void checkGridCount(const std::filesystem::path& output, const OutputOptions& options,
                    const std::vector<std::string>& labels);

/// Refuses grids of vec3 for formats other than .vdb. @throw OptionsError
void refuseVectors(const std::filesystem::path& path, const OutputOptions& output);

/// @param type   of the voxels of the source, for the dense formats
/// @param check  is given the file before it takes its name, and the errors of grids that are quantised, else none
/// @param notes  gets a line for what the format changes or does not hold
/// @return bytes written
/// @throw OptionsError  several grids for a format that holds one  @throw Error  as the writers do
std::int64_t writeOutput(const std::filesystem::path& path, const OutputOptions& output,
                         const openvdb::GridCPtrVec& grids, openvdb::MetaMap metadata, std::optional<VoxelType> type,
                         const NanoCheck& check, std::vector<std::string>& notes);

}  // namespace umbrick
