// SPDX-License-Identifier: Apache-2.0
#include "umbrick/convert/convert_frames.h"

#include <exception>
#include <future>
#include <memory>
#include <string>
#include <utility>

#include "convert/grid_job.h"
#include "convert/grid_names.h"
#include "convert/part_jobs.h"
#include "convert/settle_options.h"
#include "convert/volume_job.h"
#include "umbrick/convert/holds_grids.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/ingest/frame_sequence.h"
#include "umbrick/ingest/read_ahead.h"

namespace umbrick {
namespace {

// The options with the mask of a frame.
ConvertOptions optionsOf(const FrameFiles& frame, ConvertOptions options) {
  std::filesystem::path& mask = options.source.mask;
  // Numbered images are slices of one mask, as they are of one volume.
  if (isFramePattern(mask) && formatOfName(mask) != "images") mask = framePath(mask, frame.number);
  if (frame.inside) options.source.open.parts.frame = frame.number;
  return options;
}

// Calls `convert`; an error that it meets names the frame.
template <class Convert>
auto naming(const FrameFiles& frame, const Convert& convert) try {
  return convert();
} catch (const OptionsError&) {
  throw;
} catch (const SeveralParts&) {
  throw;
} catch (const std::exception& error) {
  std::throw_with_nested(Error("frame " + std::to_string(frame.number) + ": " + error.what()));
}

void convertVolumeFrames(const std::vector<FrameFiles>& frames, const ConvertOptions& options,
                         const FrameWritten& written) {
  // The grids of the first frame say what those of the others are.
  const auto jobOf = [&](const FrameFiles& frame) {
    return std::move(volumeJobs({frame.input}, optionsOf(frame, options)).front());
  };
  const std::vector<PartPlan> plans = naming(frames.front(), [&] {
    VolumeJob first = jobOf(frames.front());
    auto found = planParts(first, frames.front().output);
    if (first.segments)
      throw OptionsError(first.input.string() + ": options.labels: DICOM segmentations are converted one by one");
    return found;
  });
  // Frames in one file are unpacked in one go, and once more to be verified.
  std::vector<std::shared_ptr<KeptStream>> kept, again;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    kept.push_back(frames.front().inside ? keepStream() : nullptr);
    again.push_back(frames.front().inside ? keepStream() : nullptr);
  }
  // A thread opens and reads those that come while one is built and written. Each job is set before the source of its
  // frame is handed on.
  std::vector<std::unique_ptr<VolumeJob>> opened(frames.size() * plans.size());
  std::vector<ReadAhead::Open> volumes;
  for (std::size_t i = 0; i < opened.size(); ++i)
    volumes.push_back([&, i] {
      const FrameFiles& frame = frames[i / plans.size()];
      PartPlan plan = plans[i % plans.size()];
      plan.parts.frame = frame.inside ? std::optional(frame.number) : plan.parts.frame;
      plan.parts.kept = kept[i % plans.size()];
      VolumeJob job = jobOf(frame);
      usePlan(plan, job);
      job.again = again[i % plans.size()];
      auto source = openJob(job);
      opened[i] = std::make_unique<VolumeJob>(std::move(job));
      return source;
    });
  ReadAhead ahead(std::move(volumes));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const ConvertReport report = naming(frames[i], [&] {
      std::vector<VolumeJob> jobs;
      for (std::size_t plan = 0; plan < plans.size(); ++plan) {
        const auto source = ahead.next();
        VolumeJob& job = *opened[i * plans.size() + plan];
        buildVolume(*source, job);
        for (const JobGrid& built : job.grids) numberGrid(*built.grid, frames[i].number);
        jobs.push_back(std::move(job));
      }
      return writeVolumes(jobs, frames[i].output);
    });
    for (std::size_t plan = 0; plan < plans.size(); ++plan) opened[i * plans.size() + plan].reset();
    written(frames[i], report);
  }
}

void convertGridFrames(const std::vector<FrameFiles>& frames, const ConvertOptions& options,
                       const FrameWritten& written) {
  // The next file is read while the grids of one are made sparse and written.
  const auto read = [&](std::size_t i) {
    return std::async(std::launch::async, [&, i] {
      GridJob job = openGridJob(frames[i].input, optionsOf(frames[i], options));
      readGrids(job);
      return job;
    });
  };
  std::future<GridJob> next = read(0);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const ConvertReport report = naming(frames[i], [&] {
      GridJob job = next.get();
      job.frame = frames[i].number;
      if (i + 1 < frames.size()) next = read(i + 1);
      return writeGridJob(job, frames[i].output);
    });
    written(frames[i], report);
  }
}

}  // namespace

void convertFrames(const std::vector<FrameFiles>& frames, const ConvertOptions& options, const FrameWritten& written) {
  if (frames.empty()) return;
  for (const FrameFiles& frame : frames) checkOutput(frame.output, options.output, {frame.input});
  const bool grids = holdGrids({frames.front().input}, options.source);
  (grids ? convertGridFrames : convertVolumeFrames)(frames, settled(options), written);
}

}  // namespace umbrick
