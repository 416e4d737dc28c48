// umbrick convert: a volume of any format that is read to a sparse .vdb, with the loss it cost.
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "convert_grids.h"
#include "convert_report.h"
#include "formats.h"
#include "grid_names.h"
#include "grid_output.h"
#include "progress.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/grid_filters.h"
#include "umbrick/grid/read_back.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/grid/source_filters.h"
#include "umbrick/grid/verify.h"
#include "umbrick/ingest/open_volume.h"
#include "validators.h"

namespace umbrick::tools {
namespace {
namespace fs = std::filesystem;

struct ConvertOptions {
  std::vector<fs::path> inputs;
  std::vector<std::string> names, units;  // of the grids, given by the user
  fs::path input;                         // the one at hand
  GridOutput output;
  std::string unit;  // of its values
  BuildOptions build;
  std::string gridName, series;
  bool allGrids = true, verify = false;
  std::vector<std::int64_t> dims;
  std::string type, endian = "little";
  std::int64_t headerBytes = 0;
  int bitsStored = 0, threads = 0;
  std::array<double, 3> spacing{1, 1, 1}, origin{0, 0, 0};
  bool hasSpacing = false, hasOrigin = false;
  std::string background;                     // "auto", a number, or empty
  std::optional<float> threshold;             // grid units
  std::optional<std::array<float, 2>> range;  // grid units
  fs::path mask;
  std::string maskType = "u8";
  std::optional<std::array<int, 6>> crop;  // first and last voxel
  ProgressBar* bar = nullptr;
};

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

IndexBox cropBox(const ConvertOptions& options) {
  const auto& c = *options.crop;
  return {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}};
}

// Sources are streams: what wants to see the voxels twice opens them again.
void expectFile(const ConvertOptions& options, const std::string& option) {
  if (fs::exists(options.input) && !fs::is_regular_file(options.input) && !fs::is_directory(options.input))
    throw UsageError(options.input.string() + ": " + option + " reads the input twice: expected a file, found a pipe");
}

std::unique_ptr<VoxelSource> openMask(const ConvertOptions& options) {
  ConvertOptions mask = options;
  mask.input = options.mask;
  mask.series.clear();
  mask.headerBytes = 0;
  mask.bitsStored = 0;
  if (formatOfName(mask.input)) {
    mask.dims.clear();
    mask.type.clear();
  } else if (!mask.type.empty()) {
    mask.type = options.maskType;
  }
  return openInput(mask);
}

// The volume as it is converted: masked, then cropped.
std::unique_ptr<VoxelSource> openFiltered(const ConvertOptions& options, bool masked = true,
                                          std::uint64_t* leftOut = nullptr) {
  auto source = openInput(options);
  if (masked && !options.mask.empty()) {
    auto mask = holdsGrids(options.mask)
                    ? gridSource(options.mask.string(), readScalarGrid(options.mask).grid, source->info().dims)
                    : openMask(options);
    source = maskSource(std::move(source), std::move(mask), options.build.background.value_or(0), leftOut);
  }
  if (options.crop) source = cropSource(std::move(source), cropBox(options));
  return source;
}

// Takes the value that most of the border has for the background, and says so.
void findBackground(ConvertOptions& options) {
  expectFile(options, "--background auto");
  const BorderMode mode = borderMode(*openFiltered(options, /*masked=*/false));
  options.build.background = mode.value;
  printBackground(mode);
}

// The source is about to be read from its beginning to its end.
void beginPass(const ConvertOptions& options, const char* what, const VolumeInfo& info) {
  const double voxels = double(info.dims.x) * double(info.dims.y) * double(info.dims.z);
  options.bar->begin(what + (' ' + options.input.filename().string()), voxels * voxelBytes(info.type));
}

struct Converted {
  ConvertOptions options;  // of this input, its background found
  BuiltGrid built;
  VoxelType type = VoxelType::f32;  // as the input stores it
  std::int64_t bytesIn = 0;
  std::uint64_t leftOut = 0;  // by the mask
};

Converted buildVolume(ConvertOptions options) {
  if (options.verify) expectFile(options, "--verify");
  if (options.background == "auto") findBackground(options);
  Converted converted;
  const auto source = openFiltered(options, true, &converted.leftOut);
  beginPass(options, "converting", source->info());
  converted.built = buildGrid(*source, options.build);
  if (!options.unit.empty()) converted.built.grid->insertMeta("value_unit", openvdb::StringMetadata(options.unit));
  converted.type = source->info().type;
  converted.bytesIn = source->info().fileBytes;
  converted.options = std::move(options);
  return converted;
}

// Each input becomes a grid of the file.
Outcome convertVolumes(const ConvertOptions& options) {
  const std::vector<std::string> names = gridNames(options.inputs, options.names);
  const std::vector<std::string> units = oneForEach("--unit", options.units, options.inputs.size());
  std::vector<Converted> all;
  std::vector<openvdb::FloatGrid::ConstPtr> grids;
  for (std::size_t i = 0; i < options.inputs.size(); ++i) {
    ConvertOptions one = options;
    one.input = options.inputs[i];
    one.build.name = names[i];
    one.unit = units[i];
    all.push_back(buildVolume(one));
    grids.push_back(all.back().built.grid);
  }
  std::vector<VerifyReport> seen;
  const NanoCheck check = [&](const fs::path& written, const std::vector<QuantiseError>& quantised) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const ConvertOptions& one = all[i].options;
      BuildReport& report = all[i].built.report;
      if (!quantised.empty()) addQuantising(report, quantised[i], /*activeOnly=*/false);
      if (!options.verify) continue;
      const auto back = readBack(written, *grids[i], i);
      const auto source = openFiltered(one);
      beginPass(one, "verifying", source->info());
      seen.push_back(verifyGrid(*source, *back, one.build, report.quantising.max));
      checkVerified(options.output.path, one.build.name, seen.back(), report);
    }
  };
  Outcome outcome;
  outcome.bytesOut = writeOutput(options.output, grids, {}, all.front().type, check);
  for (std::size_t i = 0; i < all.size(); ++i) {
    printReport(all[i].options.build.name, all[i].built.report, /*dense=*/true);
    if (!options.mask.empty()) printMasked(all[i].leftOut);
    if (options.verify) printVerified(seen[i]);
    outcome.bytesIn += all[i].bytesIn;
  }
  return outcome;
}

// What of the options is for a file of grids.
GridInput gridInput(const ConvertOptions& options) {
  const auto refuse = [&](bool given, const char* option, const char* why) {
    if (given) throw UsageError(options.input.string() + ": " + option + " is for volumes: " + why);
  };
  refuse(options.background == "auto", "--background auto", "a grid states its background; give a number to change it");
  refuse(!options.names.empty(), "--name", "grids have names");
  refuse(!options.units.empty(), "--unit", "grids keep their metadata");
  GridInput input{options.input, {}, options.build, {}, {}, options.verify};
  if (!options.allGrids) input.grid = options.gridName;
  if (options.crop) input.crop = cropBox(options);
  if (options.mask.empty()) return input;
  input.mask = [&options] {
    if (holdsGrids(options.mask)) return readScalarGrid(options.mask);
    BuildOptions asItIs;
    asItIs.name = options.mask.string();
    return ScalarGrid{buildGrid(*openMask(options), asItIs).grid, asItIs.name};
  };
  return input;
}

// What the options that name values say, as the library takes it.
void setLimits(ConvertOptions& options) {
  if (!options.background.empty() && options.background != "auto")
    options.build.background = static_cast<float>(std::strtod(options.background.c_str(), nullptr));
  // What lies at the threshold is left out: the smallest value that stays is the next one.
  if (options.threshold)
    options.build.clipBelow = std::nextafter(*options.threshold, std::numeric_limits<float>::infinity());
  if (!options.range) return;
  const auto [low, high] = *options.range;
  if (low > high) {
    std::ostringstream text;
    text << "--range: expected the lower limit first, found " << low << ' ' << high;
    throw UsageError(text.str());
  }
  options.build.clipBelow = low;
  options.build.clipAbove = high;
}

// Half of the error is for what is left out and merged, half for what is quantised: left-out voxels in leaves are both.
void setQuantising(ConvertOptions& options) {
  const std::string& quantise = options.output.quantise;
  std::optional<float>& maxError = options.build.maxError;
  if (quantise == "n" && !maxError) throw UsageError("--quantise n: expected a --max-error to keep, found none");
  if (quantise.empty() || !maxError) return;
  if (quantise != "n")
    throw UsageError("--quantise " + quantise + ": expected no --max-error, which only --quantise n can keep");
  options.build.tolerance = options.output.quantiseError = *maxError / 2;
  maxError.reset();
}

int convert(ConvertOptions options) {
  const Stopwatch stopwatch;
  checkOutput(options.output, options.inputs);
  std::optional<tbb::global_control> limit;
  if (options.threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
  const StopRequest stop;
  ProgressBar bar("converting");
  options.bar = &bar;
  options.build.progress = [&](double share) {
    if (stop.requested()) throw Error(options.output.path.string() + ": interrupted before it was written");
    bar.show(share);
  };
  setLimits(options);
  setQuantising(options);
  const bool raw = !options.dims.empty() || !options.type.empty();
  bool vdb = false;
  for (const fs::path& input : options.inputs) {
    const std::string extension = input.extension().string();
    const auto named =
        extension == ".vdb" || extension == ".nvdb" ? std::optional<std::string>(extension) : formatOfName(input);
    if (raw && named)
      throw UsageError(input.string() + ": --dims and --type are for headerless raw, not for " + *named);
    vdb = vdb || (!raw && holdsGrids(input));
    if (vdb && options.inputs.size() > 1)
      throw UsageError(input.string() + ": expected volumes where there are several inputs, found a file of grids");
  }
  options.input = options.inputs.front();
  const Outcome outcome = vdb ? convertGrids(gridInput(options), options.output) : convertVolumes(options);
  std::cout << options.output.path.string() << ": " << outcome.bytesIn << " bytes in, " << outcome.bytesOut
            << " bytes out, " << std::lround(stopwatch.elapsedMs()) << " ms\n";
  return 0;
}

}  // namespace

Command addConvert(CLI::App& app) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = app.add_subcommand(
      "convert",
      "Turn volumes of many formats, a .vdb or a .nvdb into a sparse .vdb or another format; prints what was lost.");
  const CLI::Validator finite = finiteNumber();
  command
      ->add_option("input", options->inputs,
                   "a volume, told by its name or first bytes (--list-formats), or headerless raw (--dims, --type); "
                   "several become grids of one file")
      ->required();
  addListFormats(*command);
  command
      ->add_option("-o,--output", options->output.path,
                   "the file to write: .vdb, .nvdb (NanoVDB), or the dense box of the active voxels, up to 16 GiB, as "
                   ".nrrd or as .mhd with a .raw beside it, in the type of the input if it holds all values, else as "
                   "32-bit float")
      ->required();
  command->add_option("--codec", options->output.codec, "of a .vdb: blosc, zip or none [blosc]")
      ->check(CLI::IsMember({"blosc", "zip", "none"}));
  command
      ->add_option("--quantise", options->output.quantise,
                   "of a .nvdb: bits of a value, between the smallest and the largest of its leaf: 4, 8, 16, or n, in "
                   "each leaf as few as keep --max-error; the loss is measured and printed [32-bit floats]")
      ->check(CLI::IsMember({"4", "8", "16", "n"}));
  command
      ->add_option(
          "--name", options->names,
          "name of the grid, once for each volume; not for .vdb and .nvdb, whose grids have names [density; of "
          "several, the stems of the file names]")
      ->allow_extra_args(false);
  command
      ->add_option("--unit", options->units,
                   "unit of the values, kept as value_unit in the metadata of the grid; once, or once for each input "
                   "[none]")
      ->allow_extra_args(false);
  command->add_option("--grid", options->gridName,
                      "of a .vdb or .nvdb: only this grid, \"name\" or \"name[1]\" [all scalar ones]");
  command->add_option(
      "--series", options->series,
      "of a DICOM folder: the UID of a series, or its number in the list that is printed [the only one]");
  const CLI::Validator autoOrFinite(
      [](const std::string& value) { return value == "auto" ? std::string() : finiteNumber()(value); }, "");
  command
      ->add_option("--background", options->background,
                   "value of what is left out, grid units; auto: the value that most voxels on the faces of the volume "
                   "have, for which the input is read once before [0, or that of the .vdb or .nvdb]")
      ->check(autoOrFinite);
  CLI::Option* tolerance =
      command
          ->add_option("--tolerance", options->build.tolerance,
                       "leave out voxels this close to the background and merge what is this close, grid units")
          ->check(nonNegativeNumber())
          ->capture_default_str();
  CLI::Option* threshold = command
                               ->add_option("--threshold", options->threshold,
                                            "voxels at and below this value become background, grid units [none]")
                               ->check(finite);
  CLI::Option* clipBelow = command
                               ->add_option("--clip-below", options->build.clipBelow,
                                            "as --threshold, but voxels at the value itself stay, grid units [none]")
                               ->check(finite)
                               ->excludes(threshold);
  command
      ->add_option("--range", options->range,
                   "lowest and highest value that stay, both included; the rest becomes background, grid units [all]")
      ->check(finite)
      ->excludes(threshold, clipBelow);
  command->add_option(
      "--mask", options->mask,
      "a volume of the same size and place, or a .vdb: voxels where it is 0 become background; headerless "
      "raw has the same --dims");
  command->add_option("--mask-type", options->maskType, "of a voxel of a headerless mask, as --type")
      ->check(CLI::IsMember({"u8", "i8", "u16", "i16", "u32", "i32", "i64", "u64", "f16", "f32", "f64"}))
      ->capture_default_str();
  command->add_option(
      "--crop", options->crop,
      "only the voxels from x0 y0 z0 to x1 y1 z1, both included; they stay where they are in the world; of a .vdb or "
      ".nvdb by its indices");
  CLI::Option* half = command->add_flag("--half", options->build.half, "save 16-bit floats; their error counts");
  CLI::Option* step = command
                          ->add_option("--step", options->build.step,
                                       "round values to multiples of this, grid units, so that they pack better; best "
                                       "a power of two [not rounded]")
                          ->check(positiveNumber());
  command
      ->add_option("--max-error", options->build.maxError,
                   "no voxel that is kept or left out by tolerance is off by more, grid units: picks tolerance, half "
                   "floats and steps, or with --quantise n tolerance and bits")
      ->check(nonNegativeNumber())
      ->excludes(tolerance, half, step);
  command->add_flag("--verify", options->verify,
                    "read the file back before it takes its name and compare it with the input; if it is worse than "
                    "stated, exit 1 and write nothing");

  command
      ->add_option("--threads", options->threads, "that build leaves; one more reads [0: as many as there are cores]")
      ->check(CLI::Range(0, 4096));

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
