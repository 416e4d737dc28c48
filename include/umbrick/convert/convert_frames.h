// Sequences: one output for each of many numbered inputs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "umbrick/convert/convert_options.h"
#include "umbrick/convert/convert_report.h"

namespace umbrick {

/// The numbers first, first + step, ... up to last.
struct FrameRange {
  std::int64_t first = 0, last = 0, step = 1;
  bool contains(std::int64_t number) const { return number >= first && number <= last && (number - first) % step == 0; }
};

/// What a frame is read from and written to.
struct FrameFiles {
  std::int64_t number = 0;
  std::filesystem::path input, output;
  bool inside = false;  // the frame is the volume of that number in a file of several
};

struct FrameSequence {
  std::vector<FrameFiles> frames;              // in ascending order, at least one
  std::vector<std::filesystem::path> leftOut;  // files of the pattern whose number another file has
  std::vector<FrameRange> missing;  // numbers that are wanted, or else between the first and the last, and not there
};

/// Finds the frames of a sequence. Grids of converted frames have their number as metadata `frame`, unless they have
/// one already.
/// @param input   a pattern of numbered files: isFramePattern
/// @param output  a pattern too; empty: the frames are not converted, and have no outputs
/// @param wanted  where there is none, all frames there are
/// @throw IoError       there is no such frame
/// @throw OptionsError  wanted.last < wanted.first or wanted.step < 1; frames that are single images, which are slices
/// of
///                      one volume; or as checkOutput
FrameSequence findFrames(const std::filesystem::path& input, const std::filesystem::path& output,
                         const std::optional<FrameRange>& wanted, const ConvertOptions& options = {});

/// Finds the frames of one file that holds several volumes. They are numbered from 0, as in PartChoice::frame.
/// @param output  a pattern of numbered files, or empty as above
/// @throw OptionsError, IoError  as findFrames does, or as describeVolume
FrameSequence findFramesInside(const std::filesystem::path& input, const std::filesystem::path& output,
                               const std::optional<FrameRange>& wanted, const ConvertOptions& options = {});

/// Is called for each frame that has been written.
using FrameWritten = std::function<void(const FrameFiles&, const ConvertReport&)>;

/// Converts one frame after the other as convert does. The next ones are read in a thread while one is built and
/// written. Where source.mask is a pattern, each frame has the mask of its number.
/// @throw OptionsError  as convert
/// @throw Error         anything else that a frame meets; the message names the frame, and the error itself is nested
/// in
///                      this one. Frames before it stay written.
void convertFrames(const std::vector<FrameFiles>& frames, const ConvertOptions& options, const FrameWritten& written);

}  // namespace umbrick
