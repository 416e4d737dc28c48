// What every source says about where its voxels came from.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string_view>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Adds the metadata source_format and source_file (its name without folders), in place of what the file says.
void addProvenance(VolumeInfo& info, const std::filesystem::path& path, std::string_view format);

/// The place of a volume, checked: finite, and three independent directions.
/// @param field  what messages call it
/// @throw IoError
void checkPlace(const VolumeInfo& info, const std::string& field);

}  // namespace umbrick
