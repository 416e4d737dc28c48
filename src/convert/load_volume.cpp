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
  reading.labels.reset();
  reading.source.open.parts.allComponents = false;
  VolumeJob job = std::move(volumeJobs({input}, settled(reading)).front());
  if (!options.build.background && !isPipe(input)) {
    job.report.background = typicalBorder(input, job.options.source);
    job.options.build.background = job.report.background->value;
  }
  buildVolume(*openJob(job), job);
  LoadedVolume loaded;
  loaded.grid.grid = openvdb::gridPtrCast<openvdb::FloatGrid>(job.grids.front().grid);
  loaded.grid.name = loaded.grid.grid->getName();
  loaded.report = std::move(job.grids.front().report);
  loaded.grid.conversionError = loaded.report.build.conversionError;
  return loaded;
}

}  // namespace umbrick
