// SPDX-License-Identifier: Apache-2.0
#include "convert/part_jobs.h"

#include <exception>
#include <utility>

#include "convert/segment_filters.h"
#include "convert/write_output.h"
#include "umbrick/convert/options_error.h"

namespace umbrick {
namespace {
namespace fs = std::filesystem;

constexpr std::int64_t kMostGrids = 256;  // that one volume becomes without being asked for each

// Refuses options that a kind of grid has no use for.
class Refusal {
 public:
  Refusal(const VolumeJob& job, std::string what) : job_(job), what_(std::move(what)) {}
  void when(bool given, const char* field) const {
    if (given) throw OptionsError(job_.input.string() + ": " + field + " is not for " + what_);
  }
  void limits() const {
    const BuildOptions& build = job_.options.build;
    const SourceOptions& source = job_.options.source;
    when(source.backgroundFromBorder, "source.backgroundFromBorder");
    when(source.resample.has_value(), "source.resample");
    when(build.clipBelow || build.clipAbove, "build.clipBelow");
    when(build.half, "build.half");
    when(build.step > 0, "build.step");
    when(build.maxError.has_value(), "build.maxError");
    when(job_.options.isosurface.has_value(), "options.isosurface");
  }

 private:
  const VolumeJob& job_;
  std::string what_;
};

void checkVectorOptions(const VolumeJob& job, const fs::path& output) {
  refuseVectors(output, job.options.output);
  const Refusal refuse(job,
                       "a grid of vec3: choose one of its numbers by source.open.parts.component, or a grid of each "
                       "by options.eachComponent");
  refuse.limits();
  refuse.when(!job.options.source.mask.empty(), "source.mask");
}

void checkLabelOptions(const VolumeJob& job, std::int64_t layers) {
  const Refusal refuse(job, "grids of labels, which are 1 where a label is and 0 elsewhere");
  refuse.limits();
  refuse.when(job.options.build.tolerance > 0, "build.tolerance");
  refuse.when(job.options.build.background.value_or(0) != 0, "build.background");
  refuse.when(layers > 1 && !job.options.source.mask.empty(), "source.mask");
}

std::string baseName(const VolumeJob& job, const VolumeInfo& info) {
  return job.usualName ? usualGridName(info) : job.options.build.name;
}

PartPlan vectorPlan(const VolumeJob& job, const VolumeInfo& info) {
  PartPlan plan;
  plan.parts = job.options.source.open.parts;
  plan.parts.allComponents = true;
  plan.name = baseName(job, info);
  plan.notes.push_back("voxels of three numbers, a " + meaningName(info.meaning) + ", become the grid of vec3 \"" +
                       plan.name + '"');
  return plan;
}

std::vector<PartPlan> eachPlan(const VolumeJob& job, const VolumeInfo& info) {
  std::vector<PartPlan> plans;
  const std::string base = baseName(job, info);
  for (std::int64_t component = 0; component < info.components; ++component) {
    PartPlan plan;
    plan.parts = job.options.source.open.parts;
    plan.parts.component = component;
    plan.name = base + '_' + componentName(info, component);
    plans.push_back(std::move(plan));
  }
  plans.front().notes.push_back("voxels of " + std::to_string(info.components) + " numbers become a grid of each, \"" +
                                plans.front().name + "\" to \"" + plans.back().name + '"');
  return plans;
}

std::vector<PartPlan> planSeveral(const VolumeJob& job, const SeveralParts& several, const fs::path& output) {
  const VolumeInfo& info = several.info;
  const bool isSequence = info.frames > 1 && !job.options.source.open.parts.frame;
  if (isSequence || info.components > kMostGrids) throw several;
  if (info.components != 3 || job.options.eachComponent) {
    std::vector<PartPlan> plans = eachPlan(job, info);
    std::vector<std::string> names;
    for (const PartPlan& plan : plans) names.push_back(plan.name);
    checkGridCount(output, job.options.output, names);
    return plans;
  }
  checkVectorOptions(job, output);
  return {vectorPlan(job, info)};
}

// What a library refuses of the filters is what the caller asked for.
std::unique_ptr<SegmentSource> filtered(std::unique_ptr<SegmentSource> segments, const SourceOptions& source,
                                        ReadNotes& notes) try {
  return filteredSegments(std::move(segments), source, notes);
} catch (const OptionsError&) {
  throw;
} catch (const InvalidArgument& error) {
  std::throw_with_nested(OptionsError(error.what()));
}

void expectFileTwice(const VolumeJob& job) {
  if (job.options.verify) expectFile(job.input, "options.verify");
  if (job.options.source.backgroundFromBorder) expectFile(job.input, "source.backgroundFromBorder");
}

}  // namespace

std::vector<PartPlan> planParts(VolumeJob& job, const fs::path& output) {
  expectFileTwice(job);
  PartPlan whole;
  whole.parts = job.options.source.open.parts;
  if (job.options.labels) {
    whole.parts.allComponents = true;
    const SourceOptions& source = job.options.source;
    job.segments = source.open.raw ? nullptr : openDicomSegments(job.input, source.open.lengthUnit);
    if (job.segments) {
      checkLabelOptions(job, /*layers=*/1);
      const Refusal refuse(job, "segments of a DICOM segmentation, whose frames state their places");
      refuse.when(source.open.spacing.has_value(), "source.open.spacing");
      refuse.when(source.open.origin.has_value(), "source.open.origin");
      job.segments = filtered(std::move(job.segments), source, *job.notes);
      return {whole};
    }
  }
  try {
    job.opened = openInput(job.input, [&] {
      OpenOptions open = job.options.source.open;
      open.parts = whole.parts;
      return open;
    }());
  } catch (const SeveralParts& several) {
    return planSeveral(job, several, output);
  }
  if (job.options.labels)
    checkLabelOptions(job, job.opened->info().valuesPerVoxel);
  else if (job.opened->info().valuesPerVoxel > 1)
    checkVectorOptions(job, output);
  return {whole};
}

void usePlan(const PartPlan& plan, VolumeJob& job) {
  job.options.source.open.parts = plan.parts;
  if (!plan.name.empty()) job.options.build.name = job.report.label = plan.name;
  job.report.notes = plan.notes;
}

std::vector<VolumeJob> partJobs(VolumeJob job, const fs::path& output) {
  const std::vector<PartPlan> plans = planParts(job, output);
  std::vector<VolumeJob> jobs;
  for (const PartPlan& plan : plans) {
    VolumeJob part;
    part.input = job.input;
    part.options = job.options;
    part.unit = job.unit;
    part.report = job.report;
    part.opened = std::move(job.opened);  // which is there for a single plan alone, as are segments
    part.segments = std::move(job.segments);
    if (part.segments) part.notes = std::move(job.notes);
    usePlan(plan, part);
    jobs.push_back(std::move(part));
  }
  return jobs;
}

}  // namespace umbrick
