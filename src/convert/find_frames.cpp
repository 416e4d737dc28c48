// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <string>

#include "umbrick/convert/convert_frames.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/ingest/frame_sequence.h"
#include "umbrick/ingest/image_stack.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

// "12", "12-40" or "12-40:4".
std::string text(const FrameRange& range) {
  std::string out = std::to_string(range.first);
  if (range.last != range.first) out += '-' + std::to_string(range.last);
  return range.step == 1 ? out : out + ':' + std::to_string(range.step);
}

std::vector<FrameRange> missingFrames(const std::vector<FrameFiles>& frames, const FrameRange& wanted) {
  std::vector<FrameRange> missing;
  std::int64_t next = wanted.first;
  const auto addGap = [&](std::int64_t last) {  // from `next` to there
    if (next > last) return;
    const std::int64_t more = (last - next) / wanted.step;
    missing.push_back({next, next + more * wanted.step, wanted.step});
  };
  for (const FrameFiles& frame : frames) {
    addGap(frame.number - 1);
    next = frame.number + wanted.step;
  }
  addGap(wanted.last);
  return missing;
}

// A number in the names of images stands for slices of one volume, unless each file has slices of its own.
void checkImages(const FrameFiles& first) {
  const std::int64_t slices = openImageStack(first.input)->info().dims.z;
  if (slices < 2)
    throw OptionsError(first.input.string() +
                       ": expected a TIFF of several pages for each frame, found one image; images that are slices of "
                       "one volume need an output without a number in its name");
}

// Frames that are not converted have no outputs.
fs::path outputOf(const fs::path& pattern, std::int64_t number) {
  return pattern.empty() ? fs::path() : framePath(pattern, number);
}

void checkOutputs(const FrameSequence& sequence, const ConvertOptions& options) {
  for (const FrameFiles& frame : sequence.frames)
    if (!frame.output.empty()) checkOutput(frame.output, options.output, {frame.input});
}

}  // namespace

FrameSequence findFrames(const fs::path& input, const fs::path& output, const std::optional<FrameRange>& wanted,
                         const ConvertOptions& options) {
  FrameSequence sequence;
  const std::vector<NumberedFile> all = listFrames(input, &sequence.leftOut);
  const FrameRange range = wanted.value_or(FrameRange{all.front().number, all.back().number});
  if (range.last < range.first || range.step < 1)
    throw OptionsError("wanted: expected first <= last and a step of at least 1, found frames " + text(range));
  for (const NumberedFile& frame : all)
    if (range.contains(frame.number))
      sequence.frames.push_back({frame.number, frame.path, outputOf(output, frame.number)});
  if (sequence.frames.empty()) throw IoError(input.string() + ": expected frames of " + text(range) + ", found none");
  if (!options.source.open.raw && formatOfName(input) == "images") checkImages(sequence.frames.front());
  checkOutputs(sequence, options);
  sequence.missing = missingFrames(sequence.frames, range);
  return sequence;
}

FrameSequence findFramesInside(const fs::path& input, const fs::path& output, const std::optional<FrameRange>& wanted,
                               const ConvertOptions& options) {
  const std::int64_t count = describeVolume(input, options.source.open).frames;
  const FrameRange all{0, count - 1}, range = wanted.value_or(all);
  if (range.last < range.first || range.step < 1)
    throw OptionsError("wanted: expected first <= last and a step of at least 1, found frames " + text(range));
  FrameSequence sequence;
  for (std::int64_t number = std::max<std::int64_t>(range.first, 0); number <= std::min(range.last, all.last); ++number)
    if (range.contains(number)) sequence.frames.push_back({number, input, outputOf(output, number), true});
  if (sequence.frames.empty())
    throw OptionsError(input.string() + ": expected some of its frames " + text(all) + ", found frames " + text(range));
  checkOutputs(sequence, options);
  sequence.missing = missingFrames(sequence.frames, range);
  return sequence;
}

}  // namespace umbrick
