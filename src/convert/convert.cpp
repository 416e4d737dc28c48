// SPDX-License-Identifier: Apache-2.0
#include "umbrick/convert/convert.h"

#include "convert/grid_job.h"
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
  std::vector<VolumeJob> jobs = volumeJobs(inputs, settled(options));
  openEach(jobs, [](VoxelSource& source, VolumeJob& job) { buildVolume(source, job); });
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
