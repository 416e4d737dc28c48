// SPDX-License-Identifier: Apache-2.0
#include "umbrick/convert/load_volume.h"

#include <utility>

#include "convert/settle_options.h"
#include "convert/volume_job.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {
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
