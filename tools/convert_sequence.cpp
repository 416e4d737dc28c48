// SPDX-License-Identifier: Apache-2.0
#include "convert_sequence.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "command.h"
#include "frame_words.h"
#include "umbrick/convert/holds_grids.h"
#include "umbrick/core/printable.h"
#include "umbrick/ingest/frame_sequence.h"
#include "umbrick/ingest/open_volume.h"

namespace umbrick::tools {
namespace fs = std::filesystem;
namespace {

// Nothing has a number but the output or --frames.
void refuseUnnumbered(const ConvertCommand& command) {
  const std::string first = command.inputs.front().string();
  if (isFramePattern(command.output))
    throw UsageError(command.output.string() +
                     ": expected an input with a number in its name too, such as frame_%04d.nrrd, found " + first);
  if (!command.frames.empty())
    throw UsageError("--frames: expected an input with a number in its name, such as frame_%04d.nrrd, found " + first);
}

// Whether the input is one file of several volumes, of which more than one is wanted.
bool holdsFrames(const ConvertCommand& command, const ConvertOptions& options) try {
  const fs::path& input = command.inputs.front();
  if (command.inputs.size() != 1 || command.frame || holdsGrids(input)) return false;
  if (!isFramePattern(command.output) && command.frames.empty()) return false;
  return describeVolume(input, options.source.open).frames > 1;
} catch (const InvalidArgument&) {
  return false;  // such as a file of no known format: what is wrong is told where it is opened
}

FrameSequence framesInside(const ConvertCommand& command, const ConvertOptions& options) {
  const fs::path& input = command.inputs.front();
  if (!isFramePattern(command.output))
    throw UsageError(input.string() + ": expected an output with a number in its name, such as out_%04d.vdb, found " +
                     command.output.string());
  const auto asked = command.frames.empty() ? std::nullopt : std::optional(parseFrameRange(command.frames));
  FrameSequence sequence = findFramesInside(input, command.output, asked, options);
  tellMissing(input, sequence.missing);
  return sequence;
}

}  // namespace

std::optional<FrameSequence> findSequence(const ConvertCommand& command, const ConvertOptions& options) {
  const std::vector<fs::path>& inputs = command.inputs;
  const auto input = std::find_if(inputs.begin(), inputs.end(), isFramePattern);
  if (input == inputs.end()) {
    if (holdsFrames(command, options)) return framesInside(command, options);
    refuseUnnumbered(command);
    return {};
  }
  const bool numberedOutput = isFramePattern(command.output);
  const bool images = !command.raw() && formatOfName(*input) == "images";
  if (images && !numberedOutput && command.frames.empty()) return {};
  if (!numberedOutput)
    throw UsageError(input->string() +
                     ": expected an output with a number in its name too, such as out_%04d.vdb, found " +
                     command.output.string());
  if (inputs.size() > 1)
    throw UsageError(input->string() + ": expected one input where frames are numbered, found " +
                     std::to_string(inputs.size()));
  const auto asked = command.frames.empty() ? std::nullopt : std::optional(parseFrameRange(command.frames));
  FrameSequence sequence = findFrames(*input, command.output, asked, options);
  tellMissing(*input, sequence.missing);
  for (const fs::path& file : sequence.leftOut)
    std::cerr << printable(file.string()) << ": left out: another file has its number, or the number is too large\n";
  return sequence;
}

}  // namespace umbrick::tools
