// What every source says about where its voxels came from.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string_view>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Adds the metadata source_format and source_file (its name without folders), in place of what the file says.
void addProvenance(VolumeInfo& info, const std::filesystem::path& path, std::string_view format);

}  // namespace umbrick
