// SPDX-License-Identifier: Apache-2.0
#include "umbrick/convert/plan_volumes.h"

#include "convert/pass.h"
#include "convert/settle_options.h"
#include "convert/volume_job.h"
#include "umbrick/convert/holds_grids.h"
#include "umbrick/convert/options_error.h"

namespace umbrick {
namespace fs = std::filesystem;

std::vector<VolumePlan> planVolumes(const std::vector<fs::path>& inputs, const ConvertOptions& options) {
  if (holdGrids(inputs, options.source))
    throw OptionsError(inputs.front().string() + ": expected a volume to plan, found a file of grids");
  PlanOptions plan;
  plan.codec = options.output.codec.value_or(VdbCodec::blosc);
  std::vector<VolumePlan> plans;
  std::vector<VolumeJob> jobs = volumeJobs(inputs, settled(options));
  openEach(jobs, [&](VoxelSource& source, VolumeJob& job) {
    BuildOptions build = job.options.build;
    build.progress = beginPass(options.progress, ConvertStage::planning, job.input, unpackedBytes(source.info()));
    plans.push_back({job.input, job.report.background, planGrid(source, build, plan)});
  });
  return plans;
}

}  // namespace umbrick
