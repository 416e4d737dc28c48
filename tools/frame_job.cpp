// SPDX-License-Identifier: Apache-2.0
#include "frame_job.h"

#include <algorithm>
#include <iostream>
#include <string>

#include "command.h"
#include "film.h"
#include "frame_words.h"
#include "output_option.h"
#include "umbrick/convert/holds_grids.h"
#include "umbrick/core/printable.h"
#include "umbrick/ingest/frame_sequence.h"
#include "umbrick/ingest/open_volume.h"
#include "umbrick/render/open_reference.h"

namespace umbrick::tools {
namespace fs = std::filesystem;
namespace {

std::optional<FrameRange> askedRange(const FrameOptions& options) {
  return options.range.empty() ? std::nullopt : std::optional(parseFrameRange(options.range));
}

// Whether the volume is one file of several.
bool holdsFrames(const VolumeReference& volume) try {
  if (!volume.raw && holdsGrids(volume.file)) return false;
  return describeVolume(volume.file, openOptions(volume)).frames > 1;
} catch (const InvalidArgument&) {
  return false;  // what is wrong is told where it is opened
}

// The frames that follow from files.
FrameJob jobOf(const FrameSequence& sequence, const VolumeReference& volume, const FrameOptions& options) {
  FrameJob job;
  if (const std::string gaps = missingText(sequence.missing); !gaps.empty()) {
    if (!options.skipMissing)
      throw Error(volume.file.string() + ": " + gaps + "; --skip-missing goes on without them, --frames picks others");
    job.notes.push_back(volume.file.string() + ": " + gaps);
  }
  for (const fs::path& file : sequence.leftOut)
    job.notes.push_back(file.string() + ": left out: another file has its number, or the number is too large");
  const FrameRange range =
      askedRange(options).value_or(FrameRange{sequence.frames.front().number, sequence.frames.back().number});
  const auto count = static_cast<double>((range.last - range.first) / range.step + 1);
  job.step = range.step;
  job.skipMissing = options.skipMissing;
  for (const FrameFiles& files : sequence.frames) {
    FrameJob::Frame frame{.number = files.number, .volume = volume};
    frame.volume.file = files.input;
    // The frame stands in front of the component: "[3].x".
    if (files.inside) frame.volume.grid = '[' + std::to_string(files.number) + ']' + volume.grid;
    frame.turn = static_cast<double>((files.number - range.first) / range.step) / count;
    job.frames.push_back(std::move(frame));
  }
  return job;
}

FrameJob turntable(const VolumeReference& volume, int count) {
  FrameJob job;
  job.oneVolume = true;
  for (int i = 0; i < count; ++i) job.frames.push_back({.number = i, .volume = volume, .turn = double(i) / count});
  return job;
}

std::optional<FrameJob> framesOf(const RenderCommand& command, const VolumeReference& volume) {
  const FrameOptions& options = command.frames;
  const std::vector<fs::path>& files = command.output->files;
  const auto numbered = std::find_if(files.begin(), files.end(), isFramePattern);
  const auto film = std::find_if(files.begin(), files.end(), isFilm);
  if (options.count && !options.range.empty())
    throw UsageError("--count and --frames exclude each other: one is of pictures of one volume, the other of volumes");
  if (options.count) return turntable(volume, *options.count);
  const bool several = numbered != files.end() || film != files.end() || !options.range.empty();
  if (!several && options.orbit != 0)
    throw UsageError("--orbit: expected several pictures: --count, or a sequence with an output such as out_%04d.png");
  if (!several && options.shutter > 0)
    throw UsageError("--shutter: expected several pictures, by --count or of a sequence");
  if (!several) return {};
  if (std::optional<FrameJob> job = findSequence(volume, command.scene->volume.frame.has_value(), options)) {
    for (const std::string& note : job->notes) std::cerr << printable(note) << '\n';
    return job;
  }
  if (!options.range.empty())
    throw UsageError("--frames: is for sequences, as 'smoke_%04d.vdb' or a file of several volumes, found " +
                     volume.file.string() +
                     "; --repeat draws one picture several times, --count makes several of one volume");
  throw UsageError((film != files.end() ? film : numbered)->string() +
                   ": expected a sequence, as 'smoke_%04d.vdb', or --count with the number of pictures, found " +
                   volume.file.string());
}

bool isThere(const fs::path& file) {
  std::error_code none;
  return fs::exists(file, none);
}

// Shares the outputs out to the frames and looks whether they can be written.
void placeOutputs(const RenderCommand& command, FrameJob& job) {
  PictureOutput& output = *command.output;
  bool files = false, streams = false;
  for (fs::path file : output.files) {
    if (isFilm(file)) {
      job.films.push_back(file);
      continue;
    }
    pictureFormat(file, output.format);
    if (isStream(file)) {
      if (!command.ranks->isAlone())
        throw UsageError(file.string() + ": the frames of " + std::to_string(command.ranks->count()) +
                         " ranks have no order on a stream; numbered files and films do");
      prepareOutput(file, output.force);
      streams = true;
    } else if (!isFramePattern(file)) {
      throw UsageError(file.string() +
                       ": expected an output with a number in its name for several pictures, as out_%04d.png, or a "
                       "film (.mp4, .webm)");
    }
    files = true;
    for (FrameJob::Frame& frame : job.frames) frame.pictures.push_back(framePath(file, frame.number));
  }
  const bool ownStats = isFramePattern(output.stats);
  if (!ownStats) job.stats = output.stats;
  prepareOutput(job.stats, output.force);
  for (FrameJob::Frame& frame : job.frames) {
    if (ownStats) frame.stats = framePath(output.stats, frame.number);
    frame.finished = files && !streams && job.films.empty() && !command.frames.overwrite &&
                     std::all_of(frame.pictures.begin(), frame.pictures.end(), isThere) &&
                     (!ownStats || isThere(frame.stats));
    if (frame.finished) continue;
    for (fs::path file : frame.pictures)
      if (!isStream(file)) prepareOutput(file, output.force);
    prepareOutput(frame.stats, output.force);
  }
  std::vector<fs::path> all = job.frames.front().pictures;
  all.insert(all.end(), job.films.begin(), job.films.end());
  all.insert(all.end(), {job.stats, job.frames.front().stats});
  checkApart(all);
  for (fs::path film : job.films) {
    if (command.ranks->isFirst()) requireFilmEncoder(film);
    prepareOutput(film, output.force);
  }
}

void tellFinished(const FrameJob& job) {
  std::vector<std::int64_t> numbers;
  for (const FrameJob::Frame& frame : job.frames)
    if (frame.finished) numbers.push_back(frame.number);
  if (numbers.empty()) return;
  std::cerr << numbers.size() << " of " << job.frames.size()
            << " frames are there and stay: " << rangesText(rangesOf(numbers, job.step))
            << "; --overwrite draws all again\n";
}

}  // namespace

std::optional<FrameJob> findSequence(const VolumeReference& volume, bool one, const FrameOptions& options) {
  ConvertOptions open;
  open.source.open = openOptions(volume);
  if (isFramePattern(volume.file))
    return jobOf(findFrames(volume.file, {}, askedRange(options), open), volume, options);
  // A scene of one frame names it as "[3]".
  if (!one && !volume.grid.starts_with('[') && holdsFrames(volume))
    return jobOf(findFramesInside(volume.file, {}, askedRange(options), open), volume, options);
  return {};
}

std::optional<FrameJob> findFrameJob(const RenderCommand& command, const Scene& scene) {
  refuseSeveralNumbers(scene.volume.file);
  for (const fs::path& file : command.output->files) refuseSeveralNumbers(file);
  refuseSeveralNumbers(command.output->stats);
  std::optional<FrameJob> job = framesOf(command, scene.volume);
  if (!job) return {};
  if (command.progressive())
    throw UsageError("--progressive, --max-seconds and --target-error are for one picture; --samples averages frames");
  if (command.frames.shutter > 0) {
    const bool moves = command.frames.orbit != 0 || std::ranges::any_of(scene.tracks, [](const SceneTrack& track) {
                         return track.field.starts_with("camera.");
                       });
    if (!moves) throw UsageError("--shutter: expected a camera that moves, by --orbit or by keys of the scene");
    if (scene.sampling.pixelSamples < 2)
      throw UsageError("--shutter: expected --samples of 2 or more, which are taken at as many times, found " +
                       std::to_string(scene.sampling.pixelSamples));
  }
  if (command.repeat > 1) throw UsageError("--repeat: is for one picture, found several frames");
  placeOutputs(command, *job);
  tellFinished(*job);
  return job;
}

}  // namespace umbrick::tools
