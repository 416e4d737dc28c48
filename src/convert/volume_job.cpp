// SPDX-License-Identifier: Apache-2.0
#include "convert/volume_job.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "convert/background.h"
#include "convert/grid_names.h"
#include "convert/pass.h"
#include "convert/replace_by_isosurface.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/grid/build_grids.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/grid/label_grids.h"
#include "umbrick/grid/resample.h"
#include "umbrick/grid/vector_grid.h"
#include "umbrick/ingest/split_components.h"

namespace umbrick {
namespace {
namespace fs = std::filesystem;

// Keeps what resampling did in the metadata of the grid.
void describeResampling(openvdb::FloatGrid& grid, const ResampleReport& report) {
  const glm::dvec3& s = report.spacing;
  grid.insertMeta("resample_spacing", openvdb::Vec3DMetadata({s.x, s.y, s.z}));
  grid.insertMeta("resample_error_max", openvdb::DoubleMetadata(report.max));
  grid.insertMeta("resample_error_rms", openvdb::DoubleMetadata(report.rms));
  grid.insertMeta("resample_integral_before", openvdb::DoubleMetadata(report.integralBefore));
  grid.insertMeta("resample_integral_after", openvdb::DoubleMetadata(report.integralAfter));
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

// What a job has to know before its volume is read.
void settleJob(VolumeJob& job) {
  if (job.options.verify) expectFile(job.input, "options.verify");
  settleBackground(job);
  if (BuildOptions& build = job.options.build; mapsValues(job.options) && makesValues(job))
    leaveOutBelow(build.background.value_or(0), build);
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

void takeValues(const VolumeInfo& info, BuiltGrid built, VolumeJob& job) {
  ConvertedGrid report = reportOf(job, info);
  if (job.options.isosurface) report.isosurface = replaceByIsosurface(job.input, *job.options.isosurface, built);
  if (job.options.source.resample) describeResampling(*built.grid, *(report.resampled = *job.notes->resampled));
  report.build = std::move(built.report);
  job.grids.push_back({built.grid, std::move(report)});
}

// What all grids of a job are given.
void describeGrids(VolumeJob& job) {
  for (JobGrid& grid : job.grids) {
    if (!job.unit.empty()) grid.grid->insertMeta("value_unit", openvdb::StringMetadata(job.unit));
    if (!job.options.source.mask.empty()) grid.report.masked = job.notes->leftOut;
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

BuildOptions passOf(const VolumeJob& job, ConvertStage stage, const VolumeInfo& info) {
  BuildOptions build = job.options.build;
  build.progress = beginPass(job.options.progress, stage, job.input, unpackedBytes(info));
  return build;
}

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
  settleJob(job);
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
  const BuildOptions build = passOf(job, ConvertStage::converting, source.info());
  job.bytesIn = source.info().fileBytes;
  if (job.options.labels) {
    takeLabels(source.info(), buildLabelGrids(source, *job.options.labels, build.progress), job);
  } else if (source.info().valuesPerVoxel > 1) {
    buildVectors(source, job, build);
  } else {
    takeValues(source.info(), buildGrid(source, build), job);
  }
  describeGrids(job);
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
  describeGrids(job);
  return worldOf(info);
}

bool shareVolume(const std::vector<VolumeJob>& jobs) {
  return jobs.size() > 1 && jobs.front().options.source.mask.empty() &&
         std::all_of(jobs.begin(), jobs.end(), [&](const VolumeJob& job) {
           return job.input == jobs.front().input && !job.opened && !job.segments &&
                  job.options.source.open.parts.component.has_value();
         });
}

World openAndBuildTogether(std::vector<VolumeJob>& jobs) {
  for (VolumeJob& job : jobs) settleJob(job);
  // All components are read, and cut, at once.
  VolumeJob& first = jobs.front();
  SourceOptions whole = first.options.source;
  whole.resample.reset();
  whole.open.parts.component.reset();
  whole.open.parts.allComponents = true;
  std::vector<std::unique_ptr<VoxelSource>> all = splitComponents(openFiltered(first.input, whole, 0, *first.notes));
  std::vector<std::unique_ptr<VoxelSource>> sources;
  std::vector<VoxelSource*> each;
  std::vector<BuildOptions> builds;
  for (VolumeJob& job : jobs) {
    const auto component = static_cast<std::size_t>(*job.options.source.open.parts.component);
    auto source = std::move(all.at(component));
    if (job.options.source.resample)
      source = resampleSource(std::move(source), *job.options.source.resample, job.notes->resampled);
    builds.push_back(&job == &first ? passOf(job, ConvertStage::converting, source->info()) : job.options.build);
    each.push_back(source.get());
    sources.push_back(std::move(source));
  }
  all.clear();
  std::vector<BuiltGrid> built = buildGrids(each, builds);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    jobs[i].bytesIn = each[i]->info().fileBytes;
    takeValues(each[i]->info(), std::move(built[i]), jobs[i]);
    describeGrids(jobs[i]);
  }
  return worldOf(each.front()->info());
}

}  // namespace umbrick
