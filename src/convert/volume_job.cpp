// SPDX-License-Identifier: Apache-2.0
#include "convert/volume_job.h"

#include <limits>
#include <utility>

#include "convert/background.h"
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

constexpr float kInfinity = std::numeric_limits<float>::infinity();

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

// Looks at how much of a volume stays, so that a background that leaves out nothing is noticed.
void judgeBackground(const openvdb::FloatGrid& grid, ConvertedGrid& report) {
  constexpr double kNearlyAll = 0.95;
  const std::uint64_t active = report.build.activeVoxels, all = report.build.voxels;
  if (2 * active <= all) return;
  if (const auto usual = usualValue(grid); usual && 2 * usual->voxels > all) report.usual = usual;
  if (static_cast<double>(active) > kNearlyAll * static_cast<double>(all)) report.borderMedian = borderMedian(grid);
}

bool mapsValues(const ConvertOptions& options) {
  return options.output.target && traitsOf(*options.output.target).unitValues && !options.isosurface;
}

// The background is the border's where that is asked for, where limits would keep the usual one or a surface would
// lie below it, or where it will be the 0 of a target.
void settleBackground(VolumeJob& job) {
  BuildOptions& build = job.options.build;
  const bool asked = job.options.source.backgroundFromBorder, given = build.background.has_value();
  if (!asked) refuseKept(job.input, build, given ? *build.background : -kInfinity, "as was asked for");
  const bool forTarget = !given && mapsValues(job.options) && !isPipe(job.input);
  const bool closed = !job.options.isosurface || job.options.isosurface->value > 0;
  const bool usualFits = given || (!keepsBackground(build, 0) && !forTarget && closed);
  if (!asked && usualFits) return;
  if (!asked && isPipe(job.input)) refuseKept(job.input, build, 0, "the usual one");
  job.report.background = asked || !forTarget ? findBackground(job.input, job.options.source)
                                              : typicalBorder(job.input, job.options.source);
  build.background = job.report.background->value;
  refuseKept(job.input, build, *build.background, "as on the border of the volume");
  if (!asked && !forTarget)
    job.settled =
        "the background is that of the border of the volume, since the usual 0 lies above the limit or the value of "
        "the surface";
}

// Makes the grids ready for a target.
void prepareForTarget(std::span<VolumeJob> jobs, ConvertReport& report) {
  const OutputOptions& output = jobs.front().options.output;
  if (!output.target) return;
  std::vector<openvdb::FloatGrid*> grids;
  for (VolumeJob& job : jobs) {
    BuildReport& build = job.report.build;
    std::optional<double> left;
    if (job.options.build.maxError) left = *job.options.build.maxError - build.maxError;
    const TargetChange change = prepareFor(output, /*foreign=*/false, left, *job.grid);
    job.map = change.map;
    if (change.half) build.storage = "half";
    if (!job.options.isosurface) addQuantising(build, change.error, /*activeOnly=*/false);
    job.report.notes.insert(job.report.notes.end(), change.notes.begin(), change.notes.end());
    grids.push_back(job.grid.get());
  }
  if (const std::string line = nameFor(*output.target, grids); !line.empty()) report.notes.push_back(line);
  for (VolumeJob& job : jobs) job.report.label = job.grid->getName();
}

// Reads the grid of the job back from the file and compares it with the volume.
void verify(VolumeJob& job, std::size_t place, const fs::path& written, const fs::path& output) {
  const auto back = readBack(written, *job.grid, place);
  ReadNotes again;
  const auto source = openFiltered(job, again);
  const BuildOptions build = passOf(job, ConvertStage::verifying, source->info());
  job.report.verified = verifyGrid(*source, *unmapped(back, job.map), build, job.report.build.quantising.max);
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
  settleBackground(job);
  // What lies below the background would be below the 0 of the target.
  if (BuildOptions& build = job.options.build; mapsValues(job.options))
    build.clipBelow = std::max(build.clipBelow.value_or(-kInfinity), build.background.value_or(0));
  return openFiltered(job, *job.notes);
}

void openEach(std::vector<VolumeJob>& jobs, const std::function<void(VoxelSource& source, VolumeJob& job)>& use) {
  World world;
  for (VolumeJob& job : jobs) {
    if (!job.options.source.world && &job != &jobs.front()) job.options.source.world = world;
    const auto source = openJob(job);
    world = completed(world, worldOf(source->info()));
    use(*source, job);
  }
}

void buildVolume(VoxelSource& source, VolumeJob& job) {
  const SourceOptions& of = job.options.source;
  ConvertedGrid& report = job.report;
  BuiltGrid built = buildGrid(source, passOf(job, ConvertStage::converting, source.info()));
  report.volumeType = source.info().type;
  report.notes = source.info().notes;
  if (!job.settled.empty()) report.notes.push_back(job.settled);
  job.bytesIn = source.info().fileBytes;
  if (job.options.isosurface) report.isosurface = replaceByIsosurface(job.input, *job.options.isosurface, built);
  if (!job.unit.empty()) built.grid->insertMeta("value_unit", openvdb::StringMetadata(job.unit));
  if (of.resample) describeResampling(*built.grid, *(report.resampled = *job.notes->resampled));
  if (!of.mask.empty()) report.masked = job.notes->leftOut;
  report.build = std::move(built.report);
  job.grid = built.grid;
}

ConvertReport writeVolumes(std::span<VolumeJob> jobs, const fs::path& output) {
  ConvertReport report;
  for (VolumeJob& job : jobs)
    if (!job.options.isosurface) judgeBackground(*job.grid, job.report);
  prepareForTarget(jobs, report);
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
  report.output = output;
  report.bytesOut = writeOutput(output, first.options.output, grids, {}, type, check, report.notes);
  for (VolumeJob& job : jobs) {
    report.bytesIn += job.bytesIn;
    report.grids.push_back(std::move(job.report));
  }
  return report;
}

}  // namespace umbrick
