// The volumes that umbrick convert reads, as they are converted.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "convert_options.h"
#include "umbrick/grid/resample.h"
#include "umbrick/grid/source_filters.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick::tools {

/// What is known of a volume when it has been read to its end.
struct ReadNotes {
  std::uint64_t leftOut = 0;  // by the mask
  std::shared_ptr<ResampleReport> resampled = std::make_shared<ResampleReport>();
};

/// The input at hand: masked, cropped, then resampled.
/// @param notes  outlive the source
std::unique_ptr<VoxelSource> openFiltered(const ConvertOptions& options, ReadNotes& notes);

/// The mask, which is a volume.
std::unique_ptr<VoxelSource> openMask(const ConvertOptions& options);

/// Takes the value that most of the border has for the background.
BorderMode findBackground(ConvertOptions& options);

/// Sources are streams: what wants to see the voxels twice opens them again.
/// @throw UsageError  the input is a pipe
void expectFile(const ConvertOptions& options, const std::string& option);

}  // namespace umbrick::tools
