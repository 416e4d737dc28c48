// Numbers of frames in words, for the commands that take sequences.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "umbrick/convert/convert_frames.h"

namespace umbrick::tools {

/// Parses "12", "12-40" or "12-40:4", where numbers may be negative: "-2-2". @throw UsageError  anything else
FrameRange parseFrameRange(const std::string& text);

/// Returns "4 to 6, 8 to 9, 11 to 29", of long lists the beginning. @param ranges  in ascending order
std::string rangesText(const std::vector<FrameRange>& ranges);
/// Returns numbers in ascending order as ranges of neighbours. @param step  between neighbours
std::vector<FrameRange> rangesOf(const std::vector<std::int64_t>& numbers, std::int64_t step);

/// Returns "24 frames are missing: 4 to 6, 8 to 9, 11 to 29"; nothing where none is.
std::string missingText(const std::vector<FrameRange>& missing);
/// Prints it in one line to stderr.
void tellMissing(const std::filesystem::path& pattern, const std::vector<FrameRange>& missing);

/// Refuses a name with two numbers or more, such as "a_%d_%d.vdb", which is no pattern of a sequence, unless there is
/// a file of that very name. @throw UsageError
void refuseSeveralNumbers(const std::filesystem::path& path);

}  // namespace umbrick::tools
