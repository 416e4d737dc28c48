// Sequences that umbrick convert is asked for: one output for each of many numbered inputs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "convert_options.h"
#include "umbrick/convert/convert_frames.h"

namespace umbrick::tools {

/// The frames where input and output have a number in their names; none where neither has, or where the input is a
/// stack of images. Says on stderr which numbers are missing.
/// @throw UsageError  one of both has a number and the other has not, or several inputs
/// @throw Error       as findFrames
std::optional<FrameSequence> findSequence(const ConvertCommand& command, const ConvertOptions& options);

}  // namespace umbrick::tools
