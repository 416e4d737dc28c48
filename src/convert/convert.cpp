// SPDX-License-Identifier: Apache-2.0
#include "umbrick/convert/convert.h"

#include <algorithm>
#include <iterator>

#include "convert/grid_job.h"
#include "convert/part_jobs.h"
#include "convert/settle_options.h"
#include "convert/volume_job.h"
#include "umbrick/convert/holds_grids.h"
#include "umbrick/convert/options_error.h"

namespace umbrick {
namespace fs = std::filesystem;

ConvertReport convertVolumes(const std::vector<fs::path>& inputs, const fs::path& output,
                             const ConvertOptions& options) {
  if (inputs.empty()) throw OptionsError(output.string() + ": expected at least one input, found none");
  checkOutput(output, options.output, inputs);
  std::vector<VolumeJob> jobs;
  World world;
  for (VolumeJob& volume : volumeJobs(inputs, settled(options))) {
    // Each is brought to the world of those before it.
    if (!volume.options.source.world && !jobs.empty()) volume.options.source.world = world;
    std::vector<VolumeJob> parts = partJobs(std::move(volume), output);
    if (shareVolume(parts))
      world = completed(world, openAndBuildTogether(parts));
    else
      for (VolumeJob& job : parts) world = completed(world, openAndBuild(job));
    std::move(parts.begin(), parts.end(), std::back_inserter(jobs));
  }
  return writeVolumes(jobs, output);
}

ConvertReport convertGrids(const fs::path& input, const fs::path& output, const ConvertOptions& options) {
  checkOutput(output, options.output, {input});
  GridJob job = openGridJob(input, settled(options));
  return writeGridJob(job, output);
}

ConvertReport convert(const std::vector<fs::path>& inputs, const fs::path& output, const ConvertOptions& options) {
  return holdGrids(inputs, options.source) ? convertGrids(inputs.front(), output, options)
                                           : convertVolumes(inputs, output, options);
}

}  // namespace umbrick
