// What umbrick info says of a volume: place, values, and what else its file holds.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "volume_options.h"

namespace umbrick::tools {

/// Prints it to stdout. Of a file with several volumes, none of which is named, it lists them.
/// @throw UsageError, IoError, InvalidArgument
void printVolumeInfo(const std::filesystem::path& input, const VolumeOptions& options, int bins, bool json);

}  // namespace umbrick::tools
