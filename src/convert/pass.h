// The stages of a conversion, each told as it begins and goes on.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>

#include "umbrick/convert/convert_progress.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Tells that a stage begins. @return what tells its share, empty where nobody listens
std::function<void(double)> beginPass(const ConvertProgressCallback& progress, ConvertStage stage,
                                      const std::filesystem::path& input, double bytes = 0);

/// The bytes of the voxels of a volume, unpacked.
double unpackedBytes(const VolumeInfo& info);

}  // namespace umbrick
