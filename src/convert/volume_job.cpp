// SPDX-License-Identifier: Apache-2.0
#include "convert/volume_job.h"

#include <utility>

#include "convert/check_verified.h"
#include "convert/grid_names.h"
#include "convert/pass.h"
#include "convert/replace_by_isosurface.h"
#include "convert/write_output.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/vdb/read_back.h"

namespace umbrick {
namespace {
namespace fs = std::filesystem;

std::unique_ptr<VoxelSource> openFiltered(const VolumeJob& job, ReadNotes& notes) {
  return openFiltered(job.input, job.options.source, job.options.build.background.value_or(0), notes);
}

// The options of a pass over the voxels, which tells how far it is.
BuildOptions passOf(const VolumeJob& job, ConvertStage stage, const VolumeInfo& info) {
  BuildOptions build = job.options.build;
  build.progress = beginPass(job.options.progress, stage, job.input, unpackedBytes(info));
  return build;
}

// Keeps what resampling did in the metadata of the grid.
void describeResampling(openvdb::FloatGrid& grid, const ResampleReport& report) {
  const glm::dvec3& s = report.spacing;
  grid.insertMeta("resample_spacing", openvdb::Vec3DMetadata({s.x, s.y, s.z}));
  grid.insertMeta("resample_error_max", openvdb::DoubleMetadata(report.max));
  grid.insertMeta("resample_error_rms", openvdb::DoubleMetadata(report.rms));
  grid.insertMeta("resample_integral_before", openvdb::DoubleMetadata(report.integralBefore));
  grid.insertMeta("resample_integral_after", openvdb::DoubleMetadata(report.integralAfter));
}

// Reads the grid of the job back from the file and compares it with the volume.
void verify(VolumeJob& job, std::size_t place, const fs::path& written, const fs::path& output) {
  const auto back = readBack(written, *job.grid, place);
  ReadNotes again;
  const auto source = openFiltered(job, again);
  const BuildOptions build = passOf(job, ConvertStage::verifying, source->info());
  job.report.verified = verifyGrid(*source, *back, build, job.report.build.quantising.max);
  checkVerified(output, build.name, *job.report.verified, job.report.build);
}

}  // namespace

std::vector<VolumeJob> volumeJobs(const std::vector<fs::path>& inputs, const ConvertOptions& options) {
  if (!options.grids.empty() && !inputs.empty())
    throw OptionsError(inputs.front().string() + ": options.grids is for files of grids: a volume has one");
  const std::vector<std::string> names = gridNames(inputs, options);
  const std::vector<std::string> units = gridUnits(inputs.size(), options.units);
  std::vector<VolumeJob> jobs(inputs.size());
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    jobs[i].input = jobs[i].report.input = inputs[i];
    jobs[i].options = options;
    jobs[i].options.build.name = jobs[i].report.label = names[i];
    jobs[i].unit = units[i];
  }
  return jobs;
}

std::unique_ptr<VoxelSource> openJob(VolumeJob& job) {
  if (job.options.verify) expectFile(job.input, "options.verify");
  if (job.options.source.backgroundFromBorder) {
    job.report.background = findBackground(job.input, job.options.source);
    job.options.build.background = job.report.background->value;
  }
  return openFiltered(job, *job.notes);
}

void buildVolume(VoxelSource& source, VolumeJob& job) {
  const SourceOptions& of = job.options.source;
  ConvertedGrid& report = job.report;
  BuiltGrid built = buildGrid(source, passOf(job, ConvertStage::converting, source.info()));
  report.volumeType = source.info().type;
  report.notes = source.info().notes;
  job.bytesIn = source.info().fileBytes;
  if (job.options.isosurface) report.isosurface = replaceByIsosurface(job.input, *job.options.isosurface, built);
  if (!job.unit.empty()) built.grid->insertMeta("value_unit", openvdb::StringMetadata(job.unit));
  if (of.resample) describeResampling(*built.grid, *(report.resampled = *job.notes->resampled));
  if (!of.mask.empty()) report.masked = job.notes->leftOut;
  report.build = std::move(built.report);
  job.grid = built.grid;
}

ConvertReport writeVolumes(std::span<VolumeJob> jobs, const fs::path& output) {
  std::vector<openvdb::FloatGrid::ConstPtr> grids;
  for (const VolumeJob& job : jobs) grids.push_back(job.grid);
  const NanoCheck check = [&](const fs::path& written, const std::vector<QuantiseError>& quantised) {
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      if (!quantised.empty()) addQuantising(jobs[i].report.build, quantised[i], /*activeOnly=*/false);
      if (jobs[i].options.verify) verify(jobs[i], i, written, output);
    }
  };
  const VolumeJob& first = jobs.front();
  // Distances are no values of the volume.
  const auto type = first.report.isosurface ? VoxelType::f32 : first.report.volumeType;
  ConvertReport report;
  report.output = output;
  report.bytesOut = writeOutput(output, first.options.output, grids, {}, type, check);
  for (VolumeJob& job : jobs) {
    report.bytesIn += job.bytesIn;
    report.grids.push_back(std::move(job.report));
  }
  return report;
}

}  // namespace umbrick
