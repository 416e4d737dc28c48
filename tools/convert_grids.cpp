// SPDX-License-Identifier: Apache-2.0
#include "convert_grids.h"

#include <algorithm>
#include <fstream>
#include <future>
#include <iostream>
#include <string_view>
#include <utility>
#include <vector>

#include "command.h"
#include "convert_isosurface.h"
#include "convert_report.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/grid_filters.h"
#include "umbrick/grid/verify.h"
#include "umbrick/ingest/open_volume.h"
#include "umbrick/vdb/grid_listing.h"
#include "umbrick/vdb/read_back.h"
#include "umbrick/vdb/read_grid.h"

namespace umbrick::tools {
namespace fs = std::filesystem;
namespace {

std::vector<std::string> selectedGrids(const GridInput& input, const GridListing& listing) {
  if (input.grid) return {*input.grid};
  std::vector<std::string> selected;
  for (const GridListing::Row& row : listing.grids)
    if (row.scalar)
      selected.push_back(row.label);
    else
      std::cerr << input.path.string() << ": grid \"" << row.label << "\" is left out: expected a scalar grid, found "
                << row.type << '\n';
  if (selected.empty()) throw InvalidArgument(input.path.string() + ": no scalar grid to convert");
  return selected;
}

// What is wrong with a mask or a crop is wrong usage.
template <class Filter>
void filtering(const fs::path& input, const Filter& filter) try {
  filter();
} catch (const InvalidArgument& error) {
  throw UsageError(input.string() + ": " + error.what());
}

void warnOfLevelSet(const GridInput& input, const std::string& label, const openvdb::FloatGrid& grid) {
  const BuildOptions& build = input.build;
  if (grid.getGridClass() == openvdb::GRID_LEVEL_SET &&
      (build.background || build.clipBelow || build.clipAbove || build.tolerance > 0))
    std::cerr << input.path.string() << ": grid \"" << label
              << "\" is a level set: --background, --tolerance, --threshold and --range do not apply to it\n";
}

// A file and its grids.
struct GridFile {
  GridInput input;
  GridListing listing;
  std::optional<ScalarGrid> mask;
  std::vector<std::string> labels;
  std::vector<ScalarGrid> grids;       // those that are read already
  std::vector<std::uint64_t> leftOut;  // by the mask
};

GridFile openGrids(GridInput input) {
  GridFile file;
  file.listing = listGrids(input.path);
  file.labels = selectedGrids(input, file.listing);
  file.leftOut.resize(file.labels.size());
  if (input.mask) filtering(input.path, [&] { file.mask = input.mask(); });
  file.input = std::move(input);
  return file;
}

// The grid as it is converted: masked, then cropped.
ScalarGrid readFiltered(const GridFile& file, std::size_t i, std::uint64_t* leftOut = nullptr) {
  const GridInput& input = file.input;
  ScalarGrid grid = readScalarGridAnyTransform(input.path, file.labels[i]);
  if (!file.mask && !input.crop) return grid;
  const auto part = grid.grid->deepCopy();
  filtering(input.path, [&] {
    const std::uint64_t masked = file.mask ? maskGrid(*part, *file.mask->grid) : 0;
    if (leftOut) *leftOut = masked;
    if (input.crop) cropGrid(*part, *input.crop);
  });
  grid.grid = part;
  return grid;
}

// What became of the grids of a file.
struct GridResult {
  std::vector<BuildReport> reports;
  std::vector<IsosurfaceReport> surfaces;  // where those are asked for
  std::vector<VerifyReport> seen;          // where that is
  std::int64_t bytes = 0;
};

GridResult convertFile(GridFile& file, const GridOutput& output) {
  const GridInput& input = file.input;
  const std::vector<std::string>& labels = file.labels;
  GridResult result;
  std::vector<openvdb::FloatGrid::ConstPtr> grids;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const ScalarGrid source =
        file.grids.empty() ? readFiltered(file, i, &file.leftOut[i]) : std::exchange(file.grids[i], {});
    warnOfLevelSet(input, labels[i], *source.grid);
    BuiltGrid built = sparsifyGrid(source, input.build);
    if (input.isosurface) result.surfaces.push_back(replaceByIsosurface(input.path, *input.isosurface, built));
    grids.push_back(built.grid);
    result.reports.push_back(built.report);
  }
  const NanoCheck check = [&](const fs::path& written, const std::vector<QuantiseError>& quantised) {
    for (std::size_t i = 0; i < grids.size(); ++i) {
      BuildReport& report = result.reports[i];
      if (!quantised.empty()) addQuantising(report, quantised[i], /*activeOnly=*/true);
      if (!input.verify) continue;
      const auto back = readBack(written, *grids[i], i);
      result.seen.push_back(verifyGrid(readFiltered(file, i), *back, input.build, report.quantising.max));
      checkVerified(output.path, labels[i], result.seen.back(), report);
    }
  };
  result.bytes = writeOutput(output, grids, file.listing.metadata, std::nullopt, check);
  return result;
}

// Opened, and its grids read.
GridFile readGrids(const GridInput& input) {
  GridFile file = openGrids(input);
  for (std::size_t i = 0; i < file.labels.size(); ++i) file.grids.push_back(readFiltered(file, i, &file.leftOut[i]));
  return file;
}

}  // namespace

bool holdsGrids(const fs::path& path) {
  if (path.extension() == ".vdb" || path.extension() == ".nvdb") return true;
  if (formatOfName(path) || !fs::is_regular_file(path)) return false;
  char magic[8]{};
  std::ifstream(path, std::ios::binary).read(magic, sizeof magic);
  const std::string_view first(magic, sizeof magic);
  return first.starts_with(" BDV") || first == "NanoVDB0";
}

Outcome convertGrids(const GridInput& input, const GridOutput& output) {
  GridFile file = openGrids(input);
  const GridResult result = convertFile(file, output);
  for (std::size_t i = 0; i < file.labels.size(); ++i) {
    if (input.isosurface)
      printIsosurface(file.labels[i], input.isosurface->value, result.surfaces[i]);
    else
      printReport(file.labels[i], result.reports[i], /*dense=*/false);
    if (input.mask) printMasked(file.leftOut[i]);
    if (input.verify) printVerified(result.seen[i]);
  }
  return {static_cast<std::int64_t>(fs::file_size(input.path)), result.bytes};
}

Outcome convertGridFrames(const std::vector<FrameFiles>& frames, const GridOutput& output,
                          const std::function<GridInput(std::size_t)>& input, ProgressBar& bar) {
  const auto read = [&](std::size_t i) {
    return std::async(std::launch::async, [&, i] { return readGrids(input(i)); });
  };
  Outcome outcome;
  std::future<GridFile> next = read(0);
  forFrames(frames, [&](std::size_t i) {
    GridFile file = next.get();
    if (i + 1 < frames.size()) next = read(i + 1);
    bar.begin("converting " + frames[i].input.filename().string());
    file.input.build.progress(0);
    GridOutput one = output;
    one.path = frames[i].output;
    const GridResult result = convertFile(file, one);
    bar.clear();
    std::optional<double> levelSetError;
    for (const IsosurfaceReport& surface : result.surfaces)
      levelSetError = std::max(levelSetError.value_or(0), surface.maxError);
    printFrame(frames[i], result.reports, result.bytes, levelSetError, file.input.verify ? ", verified" : "");
    outcome.bytesIn += static_cast<std::int64_t>(fs::file_size(frames[i].input));
    outcome.bytesOut += result.bytes;
  });
  return outcome;
}

}  // namespace umbrick::tools
