// SPDX-License-Identifier: Apache-2.0
#include "umbrick/convert/load_volume.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "convert/grid_job.h"
#include "convert/pass.h"
#include "convert/settle_options.h"
#include "convert/volume_job.h"
#include "convert/write_output.h"
#include "umbrick/convert/holds_grids.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/core/names.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {
namespace {

// The job of a volume whose grid stays in memory.
VolumeJob memoryJob(const std::filesystem::path& input, const ConvertOptions& options) {
  ConvertOptions reading = options;
  reading.output = {};
  reading.verify = false;
  reading.labels.reset();
  reading.source.open.parts.allComponents = false;
  return std::move(volumeJobs({input}, settled(reading)).front());
}

LoadedVolume load(VolumeJob& job) {
  buildVolume(*openJob(job), job);
  LoadedVolume loaded;
  loaded.grid.grid = openvdb::gridPtrCast<openvdb::FloatGrid>(job.grids.front().grid);
  loaded.grid.name = loaded.grid.grid->getName();
  loaded.report = std::move(job.grids.front().report);
  loaded.grid.conversionError = loaded.report.build.conversionError;
  return loaded;
}

LoadedVolume convertGridInMemory(const std::filesystem::path& input, const ConvertOptions& options) {
  GridJob job = openGridJob(input, settled(options));
  if (std::vector<ConvertedGrid>& rows = job.report.grids; rows.size() > 1) {
    std::vector<std::string> labels;
    for (const ConvertedGrid& row : rows) labels.push_back(row.label);
    const auto usual = std::find(labels.begin(), labels.end(), "density");
    if (usual == labels.end())
      throw OptionsError(input.string() + ": expected one grid, found " + std::to_string(labels.size()) +
                         "; name one with options.grids: " + joined(labels));
    rows = {rows[static_cast<std::size_t>(usual - labels.begin())]};
  }
  BuildOptions build = job.options.build;
  build.progress = beginPass(job.options.progress, ConvertStage::converting, input);
  LoadedVolume loaded;
  loaded.grid.grid = buildJobGrid(job, 0, build);
  loaded.grid.name = loaded.grid.grid->getName();
  loaded.report = std::move(job.report.grids.front());
  return loaded;
}

}  // namespace

LoadedVolume loadVolume(const std::filesystem::path& input, const ConvertOptions& options) {
  VolumeJob job = memoryJob(input, options);
  if (!options.build.background && !isPipe(input)) {
    job.report.background = typicalBorder(input, job.options.source);
    job.options.build.background = job.report.background->value;
  }
  return load(job);
}

LoadedVolume convertInMemory(const std::filesystem::path& input, const ConvertOptions& options) {
  if (holdGrids({input}, options.source)) return convertGridInMemory(input, options);
  VolumeJob job = memoryJob(input, options);
  LoadedVolume loaded = load(job);
  if (!options.isosurface) judgeBackground(*loaded.grid.grid, loaded.report);
  return loaded;
}

SavedGrid saveGrid(const ScalarGrid& grid, const std::filesystem::path& output, const OutputOptions& options,
                   std::optional<VoxelType> type) {
  checkOutput(output, options, {});
  if (options.target)
    throw OptionsError(output.string() + ": output.target is for conversions, which know where the values come from");
  SavedGrid saved;
  const NanoCheck keep = [&](const std::filesystem::path&, const std::vector<QuantiseError>& errors) {
    if (!errors.empty()) saved.quantised = errors.front();
  };
  saved.bytes = writeOutput(output, options, {grid.grid}, {}, type, keep, saved.notes);
  return saved;
}

}  // namespace umbrick
