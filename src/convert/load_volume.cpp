// SPDX-License-Identifier: Apache-2.0
#include "umbrick/convert/load_volume.h"

#include <utility>

#include "convert/settle_options.h"
#include "convert/volume_job.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {
namespace {
namespace fs = std::filesystem;

// Returns the value that most of the border has, or else the median of the border: measured or simulated floats
// seldom repeat, and one that does by chance says nothing.
BorderMode typicalBorder(const fs::path& input, const SourceOptions& options) {
  constexpr std::uint64_t kLeastShare = 100;  // one border voxel in so many has a value that stands out
  ReadNotes notes;
  SourceOptions whole = options;
  whole.mask.clear();  // what it leaves out becomes background itself
  whole.resample.reset();
  BorderMode mode = borderValues(*openFiltered(input, whole, 0, notes));
  if (mode.voxels * kLeastShare < mode.border) mode.value = mode.median;
  return mode;
}

}  // namespace

LoadedVolume loadVolume(const std::filesystem::path& input, const ConvertOptions& options) {
  ConvertOptions reading = options;
  reading.output = {};
  reading.verify = false;
  VolumeJob job = std::move(volumeJobs({input}, settled(reading)).front());
  if (!options.build.background && !isPipe(input)) {
    job.report.background = typicalBorder(input, job.options.source);
    job.options.build.background = job.report.background->value;
  }
  buildVolume(*openJob(job), job);
  LoadedVolume loaded;
  loaded.grid.grid = job.grid;
  loaded.grid.name = job.grid->getName();
  loaded.grid.conversionError = job.report.build.conversionError;
  loaded.report = std::move(job.report);
  return loaded;
}

}  // namespace umbrick
