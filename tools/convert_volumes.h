// Volumes to grids of a file, to a file for each frame, or to a plan of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "convert_grids.h"
#include "convert_options.h"
#include "convert_sequence.h"

namespace umbrick::tools {

/// Each input becomes a grid of the output. Prints what was lost.
Outcome convertVolumes(const ConvertOptions& options);

/// Each frame becomes a file, told in one line. A thread opens and reads those that come while one is built and
/// written.
Outcome convertVolumeFrames(const ConvertOptions& options, const std::vector<FrameFiles>& frames);

/// Prints what each input would become, told from a part of it.
void planVolumes(const ConvertOptions& options);

}  // namespace umbrick::tools
