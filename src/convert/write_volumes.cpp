// SPDX-License-Identifier: Apache-2.0
#include <set>
#include <utility>

#include "convert/check_verified.h"
#include "convert/volume_job.h"
#include "convert/write_output.h"
#include "umbrick/grid/label_grids.h"
#include "umbrick/grid/usual_value.h"
#include "umbrick/grid/vector_grid.h"
#include "umbrick/vdb/read_back.h"

namespace umbrick {
namespace {
namespace fs = std::filesystem;

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

}  // namespace

void judgeBackground(const openvdb::FloatGrid& grid, ConvertedGrid& report) {
  constexpr double kNearlyAll = 0.95;
  const std::uint64_t active = report.build.activeVoxels, all = report.build.voxels;
  if (2 * active <= all) return;
  if (const auto usual = usualValue(grid); usual && 2 * usual->voxels > all) report.usual = usual;
  if (static_cast<double>(active) > kNearlyAll * static_cast<double>(all)) report.border = usualBorder(grid);
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
