// Metadata that every source has: which file its voxels came from, and of which format.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string_view>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Sets the metadata source_format and source_file (the name of the file without its folders). Keys of the same names
/// that the file itself states are replaced.
void addProvenance(VolumeInfo& info, const std::filesystem::path& path, std::string_view format);

}  // namespace umbrick
