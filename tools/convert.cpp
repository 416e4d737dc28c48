// umbrick convert: a volume of any format that is read to a sparse .vdb, with the loss it cost.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "command.h"
#include "formats.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/ingest/open_volume.h"
#include "validators.h"

namespace umbrick::tools {
namespace {
namespace fs = std::filesystem;

struct ConvertOptions {
  fs::path input, output;
  BuildOptions build;
  std::string gridName, series;
  bool allGrids = true;
  std::vector<std::int64_t> dims;
  std::string type, endian = "little";
  std::int64_t headerBytes = 0;
  int bitsStored = 0;
  std::array<double, 3> spacing{1, 1, 1}, origin{0, 0, 0};
  bool hasSpacing = false, hasOrigin = false;
};

// A line that grows on a terminal; nothing in a pipe.
class ProgressBar {
 public:
  void show(double share) {
    if (!terminal_) return;
    std::cerr << "\rconverting " << static_cast<int>(100 * share) << " %" << std::flush;
    shown_ = true;
  }
  ~ProgressBar() {
    if (shown_) std::cerr << "\r                \r" << std::flush;
  }

 private:
  bool terminal_ = isatty(STDERR_FILENO) != 0, shown_ = false;
};

void printReport(const std::string& label, const BuildReport& report, bool dense) {
  const auto share = report.voxels > 0 ? 100.0 * double(report.activeVoxels) / double(report.voxels) : 0.0;
  char line[256];
  const auto print = [&](const char* field, const char* format, auto... values) {
    std::snprintf(line, sizeof line, format, values...);
    std::cout << "  " << field << line << '\n';
  };
  using Count = unsigned long long;
  std::cout << "grid \"" << label << "\"\n";
  print("active voxels   ", "%llu of %llu%s (%.2f %%)", Count(report.activeVoxels), Count(report.voxels),
        dense ? "" : " that were active", share);
  print("leaves, tiles   ", "%llu, %llu", Count(report.leaves), Count(report.activeTiles));
  print("maximum error   ", "%.9g%s", report.maxError + report.conversionError,
        report.maxError > 0 && report.conversionError > 0 ? " at most" : "");
  if (report.conversionError > 0) print("  to float      ", "%.9g", report.conversionError);
  if (report.clippedVoxels > 0)
    print("clipped         ", "%llu voxels, by up to %.9g", Count(report.clippedVoxels), report.maxClipChange);
  if (report.nonFinite > 0) print("not finite      ", "%llu voxels, stored as background", Count(report.nonFinite));
  if (report.backgroundChange > 0) print("background moved", " by %.9g", report.backgroundChange);
}

openvdb::MetaMap fileMetadata(openvdb::MetaMap metadata) {
  if (!metadata["creator"]) metadata.insertMeta("creator", openvdb::StringMetadata("umbrick " UMBRICK_VERSION));
  return metadata;
}

bool isVdb(const fs::path& path) {
  if (path.extension() == ".vdb") return true;
  if (formatOfName(path) || !fs::is_regular_file(path)) return false;
  char magic[4]{};
  std::ifstream(path, std::ios::binary).read(magic, sizeof magic);
  return std::string_view(magic, sizeof magic) == " BDV";
}

std::unique_ptr<VoxelSource> openInput(const ConvertOptions& options) {
  OpenOptions open;
  open.series = options.series;
  const glm::dvec3 spacing(options.spacing[0], options.spacing[1], options.spacing[2]);
  const glm::dvec3 origin(options.origin[0], options.origin[1], options.origin[2]);
  if (!options.dims.empty() || !options.type.empty()) {
    if (options.dims.size() != 3 || options.type.empty())
      throw UsageError(options.input.string() + ": headerless raw needs --dims and --type");
    RawOptions raw;
    raw.dims = {options.dims[0], options.dims[1], options.dims[2]};
    raw.type = *voxelTypeFromName(options.type);
    raw.endian = options.endian == "big" ? std::endian::big : std::endian::little;
    raw.headerBytes = options.headerBytes;
    if (options.bitsStored != 0) raw.bitsStored = options.bitsStored;
    raw.spacing = spacing;
    raw.origin = origin;
    open.raw = raw;
  } else {
    if (options.hasSpacing) open.spacing = spacing;
    if (options.hasOrigin) open.origin = origin;
  }
  try {
    return openVolume(options.input, open);
  } catch (const InvalidArgument& error) {
    throw UsageError(error.what());
  }
}

// @return bytes read
std::int64_t convertVolume(const ConvertOptions& options) {
  const auto source = openInput(options);
  const BuiltGrid built = buildGrid(*source, options.build);
  writeGrids(options.output, {built.grid}, fileMetadata({}));
  printReport(options.build.name, built.report, /*dense=*/true);
  return source->info().fileBytes;
}

std::int64_t convertVdb(const ConvertOptions& options) {
  const GridListing listing = listGrids(options.input);
  std::vector<std::string> selected;
  for (const GridListing::Row& row : listing.grids) {
    if (!options.allGrids) break;
    if (row.scalar)
      selected.push_back(row.label);
    else
      std::cerr << options.input.string() << ": grid \"" << row.label
                << "\" is left out: expected a scalar grid, found " << row.type << '\n';
  }
  if (!options.allGrids) selected.push_back(options.gridName);
  if (selected.empty()) throw InvalidArgument(options.input.string() + ": no scalar grid to convert");

  std::vector<openvdb::FloatGrid::ConstPtr> grids;
  std::vector<std::pair<std::string, BuildReport>> reports;
  for (const std::string& selector : selected) {
    const ScalarGrid source = readScalarGridAnyTransform(options.input, selector);
    const bool levelSet = source.grid->getGridClass() == openvdb::GRID_LEVEL_SET;
    if (levelSet && (options.build.background || options.build.clipBelow || options.build.tolerance > 0))
      std::cerr << options.input.string() << ": grid \"" << selector
                << "\" is a level set: --background, --tolerance and --clip-below do not apply to it\n";
    const BuiltGrid built = sparsifyGrid(source, options.build);
    grids.push_back(built.grid);
    reports.emplace_back(selector, built.report);
  }
  writeGrids(options.output, grids, fileMetadata(listing.metadata));
  for (const auto& [label, report] : reports) printReport(label, report, /*dense=*/false);
  return static_cast<std::int64_t>(fs::file_size(options.input));
}

int convert(ConvertOptions options) {
  const Stopwatch stopwatch;
  if (options.output.extension() != ".vdb")
    throw UsageError(options.output.string() + ": expected an output file that ends in .vdb");
  ProgressBar bar;
  options.build.progress = [&](double share) { bar.show(share); };
  const bool raw = !options.dims.empty() || !options.type.empty();
  const auto named =
      options.input.extension() == ".vdb" ? std::optional<std::string>(".vdb") : formatOfName(options.input);
  if (raw && named)
    throw UsageError(options.input.string() + ": --dims and --type are for headerless raw, not for " + *named);
  const std::int64_t bytesIn = !raw && isVdb(options.input) ? convertVdb(options) : convertVolume(options);
  std::cout << options.output.string() << ": " << bytesIn << " bytes in, " << fs::file_size(options.output)
            << " bytes out, " << std::lround(stopwatch.elapsedMs()) << " ms\n";
  return 0;
}

}  // namespace

Command addConvert(CLI::App& app) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App* command =
      app.add_subcommand("convert", "Turn volumes of many formats or a .vdb into a sparse .vdb; prints what was lost.");
  const CLI::Validator finite = finiteNumber();
  command
      ->add_option("input", options->input,
                   "a volume, told by its name or first bytes (--list-formats), or headerless raw (--dims, --type)")
      ->required();
  addListFormats(*command);
  command->add_option("-o,--output", options->output, "the .vdb file to write")->required();
  command->add_option("--name", options->build.name, "name of the grid (not for .vdb)")->capture_default_str();
  command->add_option("--grid", options->gridName,
                      "of a .vdb: only this grid, \"name\" or \"name[1]\" [all scalar ones]");
  command->add_option(
      "--series", options->series,
      "of a DICOM folder: the UID of a series, or its number in the list that is printed [the only one]");
  command
      ->add_option("--background", options->build.background,
                   "value of what is left out, grid units [0, or that of the .vdb]")
      ->check(finite);
  command
      ->add_option("--tolerance", options->build.tolerance,
                   "leave out voxels this close to the background and merge what is this close, grid units")
      ->check(nonNegativeNumber())
      ->capture_default_str();
  command->add_option("--clip-below", options->build.clipBelow, "voxels below become background, grid units [none]")
      ->check(finite);
  command->add_flag("--half", options->build.half, "save 16-bit floats; their error counts");

  const std::string raw = "Headerless raw";
  command->add_option("--dims", options->dims, "voxels along x (fastest), y and z")->expected(3)->group(raw);
  command->add_option("--type", options->type, "of a voxel: u8, i8, u16, i16, u32, i32, i64, u64, f16, f32, f64")
      ->check(CLI::IsMember({"u8", "i8", "u16", "i16", "u32", "i32", "i64", "u64", "f16", "f32", "f64"}))
      ->group(raw);
  command->add_option("--endian", options->endian, "little or big")
      ->check(CLI::IsMember({"little", "big"}))
      ->capture_default_str()
      ->group(raw);
  command->add_option("--header-bytes", options->headerBytes, "to skip at the start, after unpacking")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->group(raw);
  command->add_option("--bits-stored", options->bitsStored, "of an integer; bits above are masked off [all]")
      ->check(CLI::PositiveNumber)
      ->group(raw);
  command
      ->add_option("--spacing", options->spacing,
                   "world units between voxel centres along x, y, z; also of other formats that state none [1 1 1]")
      ->group(raw);
  command
      ->add_option("--origin", options->origin,
                   "world position of the centre of voxel (0, 0, 0); also of other formats that state none [0 0 0]")
      ->group(raw);
  return {command, [command, options] {
            options->allGrids = command->count("--grid") == 0;
            options->hasSpacing = command->count("--spacing") > 0;
            options->hasOrigin = command->count("--origin") > 0;
            return convert(*options);
          }};
}

}  // namespace umbrick::tools
