// SPDX-License-Identifier: Apache-2.0
#include "convert/volume_job.h"

#include <set>
#include <sstream>
#include <utility>

#include "convert/background.h"
#include "convert/check_verified.h"
#include "convert/grid_names.h"
#include "convert/pass.h"
#include "convert/replace_by_isosurface.h"
#include "convert/write_output.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/grid/label_grids.h"
#include "umbrick/grid/vector_grid.h"
#include "umbrick/vdb/read_back.h"

namespace umbrick {
namespace {
namespace fs = std::filesystem;

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
  if (static_cast<double>(active) > kNearlyAll * static_cast<double>(all)) report.border = usualBorder(grid);
}

// Whether a job makes a grid of floats out of the values of its volume: neither vectors nor labels.
bool makesValues(const VolumeJob& job) {
  if (job.options.labels) return false;
  return job.opened ? job.opened->info().valuesPerVoxel == 1 : !job.options.source.open.parts.allComponents;
}

// The background is the border's where that is asked for, where limits would keep the usual one or a surface would
// lie below it, or where it will be the 0 of a target.
void settleBackground(VolumeJob& job) {
  BuildOptions& build = job.options.build;
  const bool asked = job.options.source.backgroundFromBorder, given = build.background.has_value();
  if (!asked && given) refuseKept(job.input, build, *build.background, "as was asked for");
  const bool forTarget = !given && mapsValues(job.options) && makesValues(job) && !isPipe(job.input);
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

// The grid of a job that holds the values of its volume: neither vectors nor labels.
JobGrid* valuesOf(VolumeJob& job) {
  JobGrid& first = job.grids.front();
  return job.options.labels || !first.grid->isType<openvdb::FloatGrid>() ? nullptr : &first;
}

// Makes the grids of all jobs ready for a target.
void prepareForTarget(std::span<VolumeJob> jobs, ConvertReport& report) {
  const OutputOptions& output = jobs.front().options.output;
  if (!output.target) return;
  std::vector<openvdb::FloatGrid*> values;
  std::vector<NamedVectors> vectors;
  openvdb::GridCPtrVec all;
  for (VolumeJob& job : jobs)
    for (JobGrid& made : job.grids) {
      all.push_back(made.grid);
      if (job.options.labels) {
        prepareLabel(job.options, static_cast<openvdb::FloatGrid&>(*made.grid), made.report);
      } else if (const auto grid = openvdb::gridPtrCast<openvdb::Vec3SGrid>(made.grid)) {
        job.vectorMap = prepareVectors(job.options, job.meaning, *grid, made.report);
        // A name that was given stays.
        if (job.options.names.empty()) vectors.push_back({grid.get(), job.meaning, job.vectorMap->velocity});
      } else {
        values.push_back(static_cast<openvdb::FloatGrid*>(made.grid.get()));
        job.map = prepareFor(job.options, /*foreign=*/false, *values.back(), made.report);
      }
    }
  if (const std::string line = nameFor(*output.target, values); !line.empty()) report.notes.push_back(line);
  for (std::string& line : nameVectors(*output.target, vectors, all)) report.notes.push_back(std::move(line));
  for (VolumeJob& job : jobs)
    for (JobGrid& made : job.grids) made.report.label = made.grid->getName();
}

std::unique_ptr<VoxelSource> openAgain(const VolumeJob& job, ReadNotes& notes) {
  SourceOptions source = job.options.source;
  source.open.parts.kept = job.again;
  return openFiltered(job.input, source, job.options.build.background.value_or(0), notes);
}

// Reads the grids of the job back from the file and compares them with the volume.
// @param place  of the first one in the file
void verify(VolumeJob& job, std::size_t place, const fs::path& written, const fs::path& output) {
  ReadNotes again;
  const auto source = job.segments ? nullptr : openAgain(job, again);
  const BuildOptions build = passOf(job, ConvertStage::verifying, job.segments ? job.segments->info() : source->info());
  std::vector<VerifyReport> seen;
  if (job.options.labels) {
    std::vector<VolumeLabel> labels;
    std::vector<openvdb::FloatGrid::ConstPtr> back;
    for (std::size_t i = 0; i < job.grids.size(); ++i) {
      labels.push_back(*job.grids[i].report.volumeLabel);
      back.push_back(readBack(written, static_cast<const openvdb::FloatGrid&>(*job.grids[i].grid), place + i));
    }
    seen = job.segments ? verifySegmentGrids(*job.segments, labels, back, build.progress)
                        : verifyLabelGrids(*source, labels, back, build.progress);
  } else if (const auto vectors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(job.grids.front().grid)) {
    const auto back = readVectorsBack(written, *vectors, place);
    seen = {verifyVectorGrid(*source, *unmapped(back, job.vectorMap), build)};
  } else {
    const auto back = readBack(written, static_cast<const openvdb::FloatGrid&>(*job.grids.front().grid), place);
    seen = {verifyGrid(*source, *unmapped(back, job.map), build, job.grids.front().report.build.quantising.max)};
  }
  for (std::size_t i = 0; i < seen.size(); ++i) {
    job.grids[i].report.verified = seen[i];
    checkVerified(output, job.grids[i].report.label, seen[i], job.grids[i].report.build);
  }
}

// Says what becomes of the numbers of a vector or colour.
// @param forTarget  a target will say what becomes of vectors
void noteVectors(const VolumeInfo& info, bool forTarget, std::vector<std::string>& notes) {
  if (const double scale = colourScale(info); scale != 1) {
    std::ostringstream text;
    text << "colours are divided by " << scale << " to lie from 0 to 1, and keep the tone curve of the file";
    notes.push_back(text.str());
  }
  if (info.meaning != VoxelMeaning::vector) return;
  if (info.vectorToWorld != glm::dmat3(1))
    notes.push_back("vectors are turned into the axes of the world");
  else if (!forTarget)
    notes.push_back("vectors are kept as the file states them");
}

ConvertedGrid reportOf(const VolumeJob& job, const VolumeInfo& info) {
  ConvertedGrid report = job.report;
  report.volumeType = info.type;
  report.notes.insert(report.notes.end(), info.notes.begin(), info.notes.end());
  if (!job.settled.empty()) report.notes.push_back(job.settled);
  return report;
}

void takeLabels(const VolumeInfo& info, LabelGrids labels, VolumeJob& job) {
  if (labels.grids.empty())
    throw InvalidArgument(job.input.string() + ": expected labels, found no voxel that is not 0");
  for (LabelGrid& label : labels.grids) {
    ConvertedGrid report = reportOf(job, info);
    if (job.grids.empty())
      report.notes.insert(report.notes.end(), labels.notes.begin(), labels.notes.end());
    else
      report.notes.clear();
    report.label = label.grid->getName();
    report.volumeLabel = label.label;
    report.build = label.report;
    job.grids.push_back({label.grid, std::move(report)});
  }
}

void buildVectors(VoxelSource& source, VolumeJob& job, const BuildOptions& build) {
  BuiltVectors built = buildVectorGrid(source, build);
  ConvertedGrid report = reportOf(job, source.info());
  job.meaning = source.info().meaning;
  noteVectors(source.info(), job.options.output.target.has_value(), report.notes);
  report.build = std::move(built.report);
  job.grids.push_back({built.grid, std::move(report)});
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
    jobs[i].usualName = options.names.empty() && inputs.size() == 1;
  }
  return jobs;
}

std::unique_ptr<VoxelSource> openJob(VolumeJob& job) {
  if (job.options.verify) expectFile(job.input, "options.verify");
  settleBackground(job);
  if (BuildOptions& build = job.options.build; mapsValues(job.options) && makesValues(job))
    leaveOutBelow(build.background.value_or(0), build);
  return openFiltered(job.input, job.options.source, job.options.build.background.value_or(0), *job.notes,
                      std::move(job.opened));
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
  const BuildOptions build = passOf(job, ConvertStage::converting, source.info());
  job.bytesIn = source.info().fileBytes;
  if (job.options.labels) {
    takeLabels(source.info(), buildLabelGrids(source, *job.options.labels, build.progress), job);
  } else if (source.info().valuesPerVoxel > 1) {
    buildVectors(source, job, build);
  } else {
    BuiltGrid built = buildGrid(source, build);
    ConvertedGrid report = reportOf(job, source.info());
    if (job.options.isosurface) report.isosurface = replaceByIsosurface(job.input, *job.options.isosurface, built);
    if (of.resample) describeResampling(*built.grid, *(report.resampled = *job.notes->resampled));
    report.build = std::move(built.report);
    job.grids.push_back({built.grid, std::move(report)});
  }
  for (JobGrid& grid : job.grids) {
    if (!job.unit.empty()) grid.grid->insertMeta("value_unit", openvdb::StringMetadata(job.unit));
    if (!of.mask.empty()) grid.report.masked = job.notes->leftOut;
  }
}

World openAndBuild(VolumeJob& job) {
  if (!job.segments) {
    const auto source = openJob(job);
    buildVolume(*source, job);
    return worldOf(source->info());
  }
  const VolumeInfo& info = job.segments->info();
  const BuildOptions build = passOf(job, ConvertStage::converting, info);
  job.bytesIn = info.fileBytes;
  takeLabels(info, buildSegmentGrids(*job.segments, *job.options.labels, build.progress), job);
  for (JobGrid& grid : job.grids)
    if (!job.unit.empty()) grid.grid->insertMeta("value_unit", openvdb::StringMetadata(job.unit));
  return worldOf(info);
}

ConvertReport writeVolumes(std::span<VolumeJob> jobs, const fs::path& output) {
  ConvertReport report;
  for (VolumeJob& job : jobs)
    if (JobGrid* grid = valuesOf(job); grid && !job.options.isosurface)
      judgeBackground(static_cast<const openvdb::FloatGrid&>(*grid->grid), grid->report);
  prepareForTarget(jobs, report);
  openvdb::GridCPtrVec grids;
  for (const VolumeJob& job : jobs)
    for (const JobGrid& grid : job.grids) grids.push_back(grid.grid);
  const NanoCheck check = [&](const fs::path& written, const std::vector<QuantiseError>& quantised) {
    std::size_t place = 0;
    for (VolumeJob& job : jobs) {
      for (std::size_t i = 0; i < job.grids.size() && !quantised.empty(); ++i)
        addQuantising(job.grids[i].report.build, quantised[place + i], /*activeOnly=*/false);
      if (job.options.verify) verify(job, place, written, output);
      place += job.grids.size();
    }
  };
  const VolumeJob& first = jobs.front();
  const ConvertedGrid& told = first.grids.front().report;
  // Distances and labels are no values of the volume.
  const auto type = told.isosurface || told.volumeLabel ? VoxelType::f32 : told.volumeType;
  report.output = output;
  report.bytesOut = writeOutput(output, first.options.output, grids, {}, type, check, report.notes);
  // A volume that became several grids is counted once, and says once what is to be known of it.
  const VolumeJob* before = nullptr;
  std::set<std::string> said;
  for (VolumeJob& job : jobs) {
    if (!before || before->input != job.input) {
      report.bytesIn += job.bytesIn;
      said.clear();
    }
    for (JobGrid& grid : job.grids) {
      std::erase_if(grid.report.notes, [&](const std::string& note) { return !said.insert(note).second; });
      report.grids.push_back(std::move(grid.report));
    }
    before = &job;
  }
  return report;
}

}  // namespace umbrick
