// SPDX-License-Identifier: Apache-2.0
#include "convert_sequence.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <iostream>
#include <optional>
#include <string_view>

#include "command.h"
#include "umbrick/core/error.h"
#include "umbrick/ingest/frame_sequence.h"
#include "umbrick/ingest/image_stack.h"
#include "umbrick/ingest/open_volume.h"

namespace umbrick::tools {
namespace fs = std::filesystem;
namespace {

struct FrameRange {
  std::int64_t first = 0, last = 0, step = 1;
  bool contains(std::int64_t number) const { return number >= first && number <= last && (number - first) % step == 0; }
};

// "12", "12-40" or "12-40:4".
FrameRange parseRange(const std::string& text) {
  const auto refuse = [&] { throw UsageError("--frames: expected A, A-B or A-B:step with A <= B, found " + text); };
  std::string_view rest = text;
  const auto take = [&] {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (error != std::errc() || value < 0) refuse();
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    return std::min<std::int64_t>(value, 1'000'000'000'000);  // so that sums do not overflow
  };
  const auto follows = [&](char sign) {
    const bool found = rest.starts_with(sign);
    if (found) rest.remove_prefix(1);
    return found;
  };
  FrameRange range;
  range.first = range.last = take();
  if (follows('-')) range.last = take();
  if (follows(':')) range.step = take();
  if (!rest.empty() || range.last < range.first || range.step < 1) refuse();
  return range;
}

// The numbers that are not there, of those asked for or else between the first and the last, told in one line.
void printMissing(const fs::path& pattern, const std::vector<FrameFiles>& frames, const FrameRange& wanted) {
  constexpr int kMostGaps = 5;
  std::string gaps;
  std::int64_t missing = 0, next = wanted.first;
  int count = 0;
  const auto addGap = [&](std::int64_t end) {  // from `next` to the one before `end`
    if (next >= end) return;
    const std::int64_t more = (end - next - 1) / wanted.step + 1, last = next + (more - 1) * wanted.step;
    missing += more;
    if (++count > kMostGaps) return;
    gaps += (gaps.empty() ? "" : ", ") + std::to_string(next) + (more > 1 ? " to " + std::to_string(last) : "");
  };
  for (const FrameFiles& frame : frames) {
    addGap(frame.number);
    next = frame.number + wanted.step;
  }
  addGap(wanted.last + 1);
  if (missing == 0) return;
  std::cerr << pattern.string() << ": " << missing << (missing == 1 ? " frame is" : " frames are")
            << " missing: " << gaps << (count > kMostGaps ? ", ..." : "") << '\n';
}

// A number in the names of images stands for slices of one volume, unless each file has slices of its own.
void checkImages(const FrameFiles& first) {
  const std::int64_t slices = openImageStack(first.input)->info().dims.z;
  if (slices < 2)
    throw UsageError(first.input.string() +
                     ": expected a TIFF of several pages for each frame, found one image; images that are slices of "
                     "one volume need an output without a number in its name");
}

}  // namespace

std::vector<FrameFiles> findFrames(const ConvertOptions& options) {
  const std::vector<fs::path>& inputs = options.inputs;
  const fs::path& output = options.output.path;
  const std::string& range = options.frames;
  const auto input = std::find_if(inputs.begin(), inputs.end(), isFramePattern);
  const bool numberedOutput = isFramePattern(output);
  if (input == inputs.end()) {
    if (numberedOutput)
      throw UsageError(output.string() +
                       ": expected an input with a number in its name too, such as frame_%04d.nrrd, "
                       "found " +
                       inputs.front().string());
    if (!range.empty())
      throw UsageError("--frames: expected an input with a number in its name, such as frame_%04d.nrrd, found " +
                       inputs.front().string());
    return {};
  }
  const bool images = !options.raw() && formatOfName(*input) == "images";
  if (images && !numberedOutput && range.empty()) return {};
  if (!numberedOutput)
    throw UsageError(input->string() +
                     ": expected an output with a number in its name too, such as out_%04d.vdb, "
                     "found " +
                     output.string());
  if (inputs.size() > 1)
    throw UsageError(input->string() + ": expected one input where frames are numbered, found " +
                     std::to_string(inputs.size()));
  const auto asked = range.empty() ? std::nullopt : std::optional(parseRange(range));
  const std::vector<NumberedFile> all = listFrames(*input);
  const FrameRange wanted = asked.value_or(FrameRange{all.front().number, all.back().number});
  std::vector<FrameFiles> frames;
  for (const NumberedFile& frame : all)
    if (wanted.contains(frame.number)) frames.push_back({frame.number, frame.path, framePath(output, frame.number)});
  if (frames.empty()) throw IoError(input->string() + ": expected frames of " + range + ", found none");
  if (images) checkImages(frames.front());
  for (const FrameFiles& frame : frames) {
    GridOutput one = options.output;
    one.path = frame.output;
    checkOutput(one, {frame.input});
  }
  printMissing(*input, frames, wanted);
  return frames;
}

ConvertOptions frameOptions(const ConvertOptions& options, const FrameFiles& frame) {
  ConvertOptions one = options;
  one.input = frame.input;
  one.inputs = {frame.input};
  one.output.path = frame.output;
  // Numbered images are slices of one mask, as they are of one volume.
  if (isFramePattern(options.mask) && formatOfName(options.mask) != "images")
    one.mask = framePath(options.mask, frame.number);
  return one;
}

void forFrames(const std::vector<FrameFiles>& frames, const std::function<void(std::size_t)>& convert) {
  for (std::size_t i = 0; i < frames.size(); ++i) try {
      convert(i);
    } catch (const UsageError&) {
      throw;
    } catch (const std::exception& error) {
      throw Error("frame " + std::to_string(frames[i].number) + ": " + error.what());
    }
}

void printFrame(const FrameFiles& frame, const std::vector<BuildReport>& reports, std::int64_t bytes,
                std::optional<double> levelSetError, const std::string& extras) {
  std::uint64_t active = 0, voxels = 0;
  double error = 0;
  for (const BuildReport& report : reports) {
    active += report.activeVoxels;
    voxels += report.voxels;
    error = std::max(error, report.maxError + report.conversionError);
  }
  char line[192];
  std::snprintf(line, sizeof line, "%llu of %llu voxels active, %s %.9g%s, %lld bytes",
                static_cast<unsigned long long>(active), static_cast<unsigned long long>(voxels),
                levelSetError ? "level set off by" : "maximum error", levelSetError.value_or(error),
                levelSetError ? " voxels at most" : "", static_cast<long long>(bytes));
  std::cout << frame.output.string() << ": " << line << extras << std::endl;
}

}  // namespace umbrick::tools
