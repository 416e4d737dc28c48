// SPDX-License-Identifier: Apache-2.0
#include "convert_volumes.h"

#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <utility>

#include "convert_isosurface.h"
#include "convert_plan.h"
#include "convert_report.h"
#include "convert_source.h"
#include "grid_names.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/verify.h"
#include "umbrick/ingest/read_ahead.h"
#include "umbrick/vdb/read_back.h"

namespace umbrick::tools {
namespace {
namespace fs = std::filesystem;

struct Converted {
  ConvertOptions options;  // of this input, its background found
  std::optional<BorderMode> background;
  std::unique_ptr<ReadNotes> notes = std::make_unique<ReadNotes>();  // sources hold on to its place
  BuiltGrid built;
  std::optional<IsosurfaceReport> surface;
  VoxelType type = VoxelType::f32;  // as the input stores it
  std::int64_t bytesIn = 0;
  std::optional<VerifyReport> seen;
};

// The source is about to be read from its beginning to its end.
void beginPass(const ConvertOptions& options, const char* what, const VolumeInfo& info) {
  const double voxels = double(info.dims.x) * double(info.dims.y) * double(info.dims.z);
  options.bar->begin(what + (' ' + options.input.filename().string()), voxels * voxelBytes(info.type));
}

// @return the source, and what is known before it is read
std::pair<std::unique_ptr<VoxelSource>, Converted> openToConvert(ConvertOptions options) {
  Converted one;
  if (options.verify) expectFile(options, "--verify");
  if (options.background == "auto") one.background = findBackground(options);
  auto source = openFiltered(options, *one.notes);
  one.options = std::move(options);
  return {std::move(source), std::move(one)};
}

void build(VoxelSource& source, Converted& one) {
  const ConvertOptions& options = one.options;
  beginPass(options, "converting", source.info());
  one.built = buildGrid(source, options.build);
  one.type = source.info().type;
  one.bytesIn = source.info().fileBytes;
  if (options.isosurface) {
    one.surface = replaceByIsosurface(options.input, {*options.isosurface, options.halfWidth}, one.built);
    one.type = VoxelType::f32;
  }
  openvdb::FloatGrid& grid = *one.built.grid;
  if (!options.unit.empty()) grid.insertMeta("value_unit", openvdb::StringMetadata(options.unit));
  if (!options.resample.empty()) describeResampling(grid, *one.notes->resampled);
}

// Verifies the file before it takes its name, where that is asked for. @return bytes written
std::int64_t write(const GridOutput& output, std::span<Converted> all) {
  std::vector<openvdb::FloatGrid::ConstPtr> grids;
  for (const Converted& one : all) grids.push_back(one.built.grid);
  const NanoCheck check = [&](const fs::path& written, const std::vector<QuantiseError>& quantised) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const ConvertOptions& options = all[i].options;
      BuildReport& report = all[i].built.report;
      if (!quantised.empty()) addQuantising(report, quantised[i], /*activeOnly=*/false);
      if (!options.verify) continue;
      const auto back = readBack(written, *grids[i], i);
      ReadNotes again;
      const auto source = openFiltered(options, again);
      beginPass(options, "verifying", source->info());
      all[i].seen = verifyGrid(*source, *back, options.build, report.quantising.max);
      checkVerified(output.path, options.build.name, *all[i].seen, report);
    }
  };
  return writeOutput(output, grids, {}, all.front().type, check);
}

void print(const Converted& one) {
  const ConvertOptions& options = one.options;
  if (one.surface)
    printIsosurface(options.build.name, *options.isosurface, *one.surface);
  else
    printReport(options.build.name, one.built.report, /*dense=*/true);
  if (!options.mask.empty()) printMasked(one.notes->leftOut);
  if (!options.resample.empty()) printResampled(*one.notes->resampled);
  if (one.seen) printVerified(*one.seen);
}

void print(const FrameFiles& frame, const Converted& one, std::int64_t bytes) {
  std::ostringstream extras;
  extras.precision(9);
  if (one.background) extras << ", background " << one.background->value;
  if (one.seen) extras << ", verified";
  const auto levelSetError = one.surface ? std::optional(one.surface->maxError) : std::nullopt;
  printFrame(frame, {one.built.report}, bytes, levelSetError, extras.str());
}

// The options for each input, with the name and unit that are its own.
std::vector<ConvertOptions> optionsOfInputs(const ConvertOptions& options) {
  const std::vector<std::string> names = gridNames(options.inputs, options.names);
  const std::vector<std::string> units = oneForEach("--unit", options.units, options.inputs.size());
  std::vector<ConvertOptions> all(options.inputs.size(), options);
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].input = options.inputs[i];
    all[i].build.name = names[i];
    all[i].unit = units[i];
  }
  return all;
}

}  // namespace

Outcome convertVolumes(const ConvertOptions& options) {
  std::vector<Converted> all;
  for (const ConvertOptions& input : optionsOfInputs(options)) {
    auto [source, one] = openToConvert(input);
    if (one.background) printBackground(*one.background);
    build(*source, one);
    all.push_back(std::move(one));
  }
  Outcome outcome;
  outcome.bytesOut = write(options.output, all);
  options.bar->clear();
  for (const Converted& one : all) {
    print(one);
    outcome.bytesIn += one.bytesIn;
  }
  return outcome;
}

Outcome convertVolumeFrames(const ConvertOptions& options, const std::vector<FrameFiles>& frames) {
  std::vector<Converted> opened(frames.size());  // each is set before the source of its frame is handed on
  std::vector<ReadAhead::Open> volumes;
  for (std::size_t i = 0; i < frames.size(); ++i)
    volumes.push_back([&, i] {
      auto [source, one] = openToConvert(optionsOfInputs(frameOptions(options, frames[i])).front());
      opened[i] = std::move(one);
      return std::move(source);
    });
  ReadAhead ahead(std::move(volumes));
  Outcome outcome;
  forFrames(frames, [&](std::size_t i) {
    const auto source = ahead.next();
    Converted& one = opened[i];
    build(*source, one);
    const std::int64_t bytes = write(one.options.output, {&one, 1});
    options.bar->clear();
    print(frames[i], one, bytes);
    outcome.bytesIn += one.bytesIn;
    outcome.bytesOut += bytes;
    one = {};
  });
  return outcome;
}

void planVolumes(const ConvertOptions& options) {
  PlanOptions plan;
  plan.codec = codecOf(options.output);
  const char* codec = plan.codec == VdbCodec::zip ? "zip" : plan.codec == VdbCodec::none ? "not packed" : "blosc";
  for (const ConvertOptions& input : optionsOfInputs(options)) {
    const auto [source, one] = openToConvert(input);
    if (one.background) printBackground(*one.background);
    beginPass(one.options, "planning", source->info());
    const GridPlan planned = planGrid(*source, one.options.build, plan);
    options.bar->clear();
    printPlan(input.input, planned, codec);
  }
}

}  // namespace umbrick::tools
