// SPDX-License-Identifier: Apache-2.0
#include "convert/grid_job.h"

#include <algorithm>
#include <string>
#include <utility>

#include "convert/background.h"
#include "convert/check_verified.h"
#include "convert/grid_names.h"
#include "convert/pass.h"
#include "convert/replace_by_isosurface.h"
#include "convert/target_grid.h"
#include "convert/volume_source.h"
#include "convert/write_output.h"
#include "umbrick/convert/holds_grids.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/grid/grid_filters.h"
#include "umbrick/grid/grid_world.h"
#include "umbrick/vdb/read_back.h"
#include "umbrick/vdb/read_grid.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

// Refuses what is for volumes.
void checkOptions(const fs::path& input, const ConvertOptions& options) {
  const auto refuse = [&](bool given, const char* field, const char* why) {
    if (given) throw OptionsError(input.string() + ": " + field + " is for volumes: " + why);
  };
  refuse(options.source.backgroundFromBorder, "source.backgroundFromBorder",
         "a grid states its background; give a number to change it");
  refuse(options.source.resample.has_value(), "source.resample", "a grid keeps its voxels");
  refuse(!options.source.open.lengthUnit.empty(), "source.open.lengthUnit", "a grid keeps its world");
  refuse(options.labels.has_value(), "options.labels", "a grid has values, not labels");
  refuse(options.eachComponent || options.source.open.parts.component || options.source.open.parts.magnitude,
         "source.open.parts.component", "grids keep their numbers");
  refuse(!options.names.empty(), "options.names", "grids have names");
  refuse(!options.units.empty(), "options.units", "grids keep their metadata");
}

void selectGrids(GridJob& job) {
  ConvertReport& report = job.report;
  const auto select = [&](const std::string& label) {
    report.grids.emplace_back();
    report.grids.back().input = job.input;
    report.grids.back().label = label;
  };
  for (const std::string& grid : job.options.grids) {
    for (const ConvertedGrid& row : report.grids)
      if (row.label == grid)
        throw OptionsError(job.input.string() + ": options.grids: expected each grid once, found \"" + grid +
                           "\" twice");
    select(grid);
  }
  if (!job.options.grids.empty()) return;
  std::string others;
  for (const GridListing::Row& row : job.listing.grids)
    if (row.scalar) {
      select(row.label);
    } else {
      report.leftOut.push_back({row.label, row.type});
      others += (others.empty() ? ", but \"" : ", \"") + row.label + "\" of type " + row.type;
    }
  if (report.grids.empty()) throw InvalidArgument(job.input.string() + ": no scalar grid to convert" + others);
}

// Does what a mask or a box asks for. Where they do not fit, the options are wrong.
template <class Filter>
void filtering(const fs::path& input, const Filter& filter) try {
  filter();
} catch (const OptionsError&) {
  throw;
} catch (const InvalidArgument& error) {
  throw OptionsError(input.string() + ": " + error.what());
}

ScalarGrid readMask(const SourceOptions& source) {
  if (holdsGrids(source.mask)) return readMaskGrid(source.mask);
  BuildOptions asItIs;
  asItIs.name = source.mask.string();
  return {buildGrid(*openMask(source), asItIs).grid, asItIs.name};
}

// Reads a grid as it is converted: masked, then cropped.
// @param masked  is told how many voxels the mask left out, where there is one
// @param notes   gets a line for each change of its world
ScalarGrid readFiltered(const GridJob& job, const std::string& label, std::optional<std::uint64_t>& masked,
                        std::vector<std::string>& notes) {
  ScalarGrid grid = readScalarGridAnyTransform(job.input, label);
  filtering(job.input, [&] { grid.grid = inSpace(grid.grid, job.options.source.open.space, notes); });
  const std::optional<IndexBox>& crop = job.options.source.crop;
  if (!job.mask && !crop) return grid;
  const auto part = grid.grid->deepCopy();
  filtering(job.input, [&] {
    if (job.mask) {
      std::vector<std::string> changes;
      masked = maskGrid(*part, *inWorld(job.mask->grid, worldOf(*part), changes));
      for (const std::string& change : changes) notes.push_back("mask " + job.mask->name + ": " + change);
    }
    if (crop) cropGrid(*part, *crop);
  });
  grid.grid = part;
  return grid;
}

bool keepsLevelSet(const openvdb::FloatGrid& grid, const BuildOptions& build) {
  return grid.getGridClass() == openvdb::GRID_LEVEL_SET &&
         (build.background || build.clipBelow || build.clipAbove || build.tolerance > 0);
}

// Reads a grid back from the file and compares it with the one it was made of.
void verify(GridJob& job, std::size_t i, const openvdb::FloatGrid& grid, const std::optional<ValueMap>& map,
            const fs::path& written, const fs::path& output) {
  ConvertedGrid& row = job.report.grids[i];
  const auto back = readBack(written, grid, i);
  BuildOptions options = job.options.build;
  options.progress = beginPass(job.options.progress, ConvertStage::verifying, job.input);
  std::optional<std::uint64_t> again;
  std::vector<std::string> notesAgain;
  row.verified = verifyGrid(readFiltered(job, row.label, again, notesAgain), *unmapped(back, map), options,
                            row.build.quantising.max);
  checkVerified(output, row.label, *row.verified, row.build);
}

// Makes the grids ready for a target. @return how their values are found again
std::vector<std::optional<ValueMap>> prepareForTarget(GridJob& job, const std::vector<openvdb::FloatGrid::Ptr>& grids) {
  std::vector<std::optional<ValueMap>> maps(grids.size());
  const OutputOptions& output = job.options.output;
  if (!output.target) return maps;
  std::vector<openvdb::FloatGrid*> changed;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    maps[i] = prepareFor(job.options, /*foreign=*/true, *grids[i], job.report.grids[i]);
    changed.push_back(grids[i].get());
  }
  if (const std::string line = nameFor(*output.target, changed); !line.empty()) job.report.notes.push_back(line);
  return maps;
}

}  // namespace

GridJob openGridJob(const fs::path& input, const ConvertOptions& options) {
  checkOptions(input, options);
  GridJob job;
  job.input = input;
  job.options = options;
  job.listing = listGrids(input);
  selectGrids(job);
  job.report.bytesIn = static_cast<std::int64_t>(fs::file_size(input));
  if (!options.source.mask.empty()) filtering(input, [&] { job.mask = readMask(options.source); });
  return job;
}

void readGrids(GridJob& job) {
  for (ConvertedGrid& row : job.report.grids) job.grids.push_back(readFiltered(job, row.label, row.masked, row.notes));
}

openvdb::FloatGrid::Ptr buildJobGrid(GridJob& job, std::size_t i, const BuildOptions& given) {
  BuildOptions options = given;
  ConvertedGrid& row = job.report.grids[i];
  const ScalarGrid source =
      job.grids.empty() ? readFiltered(job, row.label, row.masked, row.notes) : std::exchange(job.grids[i], {});
  if (source.grid->getGridClass() != openvdb::GRID_LEVEL_SET) {
    const float background = options.background.value_or(source.grid->background());
    refuseKept(job.input, options, background, options.background ? "as was asked for" : "that of the grid");
    if (mapsValues(job.options)) leaveOutBelow(background, options);
  }
  row.keptLevelSet = keepsLevelSet(*source.grid, options);
  BuiltGrid built = sparsifyGrid(source, options);
  if (job.options.isosurface) row.isosurface = replaceByIsosurface(job.input, *job.options.isosurface, built);
  row.build = std::move(built.report);
  return built.grid;
}

ConvertReport writeGridJob(GridJob& job, const fs::path& output) {
  std::vector<std::string> labels;
  for (const ConvertedGrid& row : job.report.grids) labels.push_back(row.label);
  checkGridCount(output, job.options.output, labels);
  BuildOptions options = job.options.build;
  options.progress = beginPass(job.options.progress, ConvertStage::converting, job.input);
  std::vector<openvdb::FloatGrid::Ptr> built;
  for (std::size_t i = 0; i < job.report.grids.size(); ++i) built.push_back(buildJobGrid(job, i, options));
  const std::vector<std::optional<ValueMap>> maps = prepareForTarget(job, built);
  for (const openvdb::FloatGrid::Ptr& grid : built)
    if (job.frame) numberGrid(*grid, *job.frame);
  const std::vector<openvdb::FloatGrid::ConstPtr> grids(built.begin(), built.end());
  const NanoCheck check = [&](const fs::path& written, const std::vector<QuantiseError>& quantised) {
    for (std::size_t i = 0; i < grids.size(); ++i) {
      if (!quantised.empty()) addQuantising(job.report.grids[i].build, quantised[i], /*activeOnly=*/true);
      if (job.options.verify) verify(job, i, *grids[i], maps[i], written, output);
    }
  };
  job.report.output = output;
  job.report.bytesOut = writeOutput(output, job.options.output, {grids.begin(), grids.end()}, job.listing.metadata,
                                    std::nullopt, check, job.report.notes);
  return std::move(job.report);
}

}  // namespace umbrick
