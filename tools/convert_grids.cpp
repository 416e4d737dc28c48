#include "convert_grids.h"

#include <fstream>
#include <iostream>
#include <string_view>
#include <vector>

#include "command.h"
#include "convert_report.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/grid_filters.h"
#include "umbrick/grid/grid_listing.h"
#include "umbrick/grid/read_back.h"
#include "umbrick/grid/verify.h"
#include "umbrick/ingest/open_volume.h"

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

// The grid as it is converted: masked, then cropped.
ScalarGrid readFiltered(const GridInput& input, const std::string& label, std::uint64_t* leftOut = nullptr) {
  ScalarGrid grid = readScalarGridAnyTransform(input.path, label);
  if (!input.mask && !input.crop) return grid;
  const auto part = grid.grid->deepCopy();
  try {
    const std::uint64_t masked = input.mask ? maskGrid(*part, *input.mask().grid) : 0;
    if (leftOut) *leftOut = masked;
    if (input.crop) cropGrid(*part, *input.crop);
  } catch (const InvalidArgument& error) {
    throw UsageError(input.path.string() + ": " + error.what());
  }
  grid.grid = part;
  return grid;
}

void warnOfLevelSet(const GridInput& input, const std::string& label, const openvdb::FloatGrid& grid) {
  const BuildOptions& build = input.build;
  if (grid.getGridClass() == openvdb::GRID_LEVEL_SET &&
      (build.background || build.clipBelow || build.clipAbove || build.tolerance > 0))
    std::cerr << input.path.string() << ": grid \"" << label
              << "\" is a level set: --background, --tolerance, --threshold and --range do not apply to it\n";
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
  const GridListing listing = listGrids(input.path);
  const std::vector<std::string> labels = selectedGrids(input, listing);
  std::vector<openvdb::FloatGrid::ConstPtr> grids;
  std::vector<BuildReport> reports;
  std::vector<std::uint64_t> leftOut(labels.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const ScalarGrid source = readFiltered(input, labels[i], &leftOut[i]);
    warnOfLevelSet(input, labels[i], *source.grid);
    const BuiltGrid built = sparsifyGrid(source, input.build);
    grids.push_back(built.grid);
    reports.push_back(built.report);
  }
  std::vector<VerifyReport> seen;
  const NanoCheck check = [&](const fs::path& written, const std::vector<QuantiseError>& quantised) {
    for (std::size_t i = 0; i < grids.size(); ++i) {
      if (!quantised.empty()) addQuantising(reports[i], quantised[i], /*activeOnly=*/true);
      if (!input.verify) continue;
      const auto back = readBack(written, *grids[i], i);
      seen.push_back(verifyGrid(readFiltered(input, labels[i]), *back, input.build, reports[i].quantising.max));
      checkVerified(output.path, labels[i], seen.back(), reports[i]);
    }
  };
  Outcome outcome{static_cast<std::int64_t>(fs::file_size(input.path)), 0};
  outcome.bytesOut = writeOutput(output, grids, listing.metadata, std::nullopt, check);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    printReport(labels[i], reports[i], /*dense=*/false);
    if (input.mask) printMasked(leftOut[i]);
    if (input.verify) printVerified(seen[i]);
  }
  return outcome;
}

}  // namespace umbrick::tools
