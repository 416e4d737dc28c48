// SPDX-License-Identifier: Apache-2.0
#include "convert_options.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "command.h"
#include "formats.h"
#include "umbrick/ingest/frame_sequence.h"
#include "umbrick/ingest/open_volume.h"
#include "validators.h"

namespace umbrick::tools {
namespace {
namespace fs = std::filesystem;

CLI::Validator voxelType() {
  return CLI::IsMember({"u8", "i8", "u16", "i16", "u32", "i32", "i64", "u64", "f16", "f32", "f64"});
}

void addRawOptions(CLI::App& command, const std::shared_ptr<ConvertOptions>& options) {
  const std::string raw = "Headerless raw";
  command.add_option("--dims", options->dims, "voxels along x (fastest), y and z")->expected(3)->group(raw);
  command.add_option("--type", options->type, "of a voxel: u8, i8, u16, i16, u32, i32, i64, u64, f16, f32, f64")
      ->check(voxelType())
      ->group(raw);
  command.add_option("--endian", options->endian, "little or big")
      ->check(CLI::IsMember({"little", "big"}))
      ->capture_default_str()
      ->group(raw);
  command.add_option("--header-bytes", options->headerBytes, "to skip at the start, after unpacking")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->group(raw);
  command.add_option("--bits-stored", options->bitsStored, "of an integer; bits above are masked off [all]")
      ->check(CLI::PositiveNumber)
      ->group(raw);
  command
      .add_option("--spacing", options->spacing,
                  "world units between voxel centres along x, y, z; also of other formats that state none [1 1 1]")
      ->group(raw);
  command
      .add_option("--origin", options->origin,
                  "world position of the centre of voxel (0, 0, 0); also of other formats that state none [0 0 0]")
      ->group(raw);
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

// A plan writes nothing, and all else needs an output.
void checkPlan(const ConvertOptions& options) {
  if (!options.plan && options.output.path.empty()) throw UsageError("--output is required");
  if (!options.plan) return;
  for (const fs::path& input : options.inputs)
    if (!options.frames.empty() || (isFramePattern(input) && (options.raw() || formatOfName(input) != "images")))
      throw UsageError("--plan: expected volumes, found a sequence: " + input.string() + "; name one of its frames");
}

}  // namespace

IndexBox cropBox(const ConvertOptions& options) {
  const auto& c = *options.crop;
  return {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}};
}

void settleOptions(ConvertOptions& options) {
  checkPlan(options);
  if (!options.output.path.empty()) checkOutput(options.output, options.inputs);
  setLimits(options);
  setQuantising(options);
  if (!options.output.quantise.empty() && options.isosurface)
    throw UsageError("--isosurface: expected no --quantise, whose error is not that of a distance, found " +
                     options.output.quantise);
  if (options.resample.size() == 2) throw UsageError("--resample: expected one spacing or three, found 2");
}

void addConvertOptions(CLI::App& command, const std::shared_ptr<ConvertOptions>& options) {
  const CLI::Validator finite = finiteNumber();
  command
      .add_option("input", options->inputs,
                  "a volume, told by its name or first bytes (--list-formats), or headerless raw (--dims, --type); "
                  "several become grids of one file, numbered ones (frame_%04d.nrrd) a file each, where the output is "
                  "numbered too")
      ->required();
  addListFormats(command);
  command.add_option(
      "--frames", options->frames,
      "of a sequence, where input and output have a number in their names (frame_%04d.nrrd, out_%04d.vdb): "
      "A, A-B or A-B:step [all there are]");
  command.add_option(
      "-o,--output", options->output.path,
      "the file to write: .vdb, .nvdb (NanoVDB), or the dense box of the active voxels, up to 16 GiB, as "
      ".nrrd or as .mhd with a .raw beside it, in the type of the input if it holds all values, else as "
      "32-bit float");
  command.add_option("--codec", options->output.codec, "of a .vdb: blosc, zip or none [blosc]")
      ->check(CLI::IsMember({"blosc", "zip", "none"}));
  command
      .add_option("--quantise", options->output.quantise,
                  "of a .nvdb: bits of a value, between the smallest and the largest of its leaf: 4, 8, 16, or n, in "
                  "each leaf as few as keep --max-error; the loss is measured and printed [32-bit floats]")
      ->check(CLI::IsMember({"4", "8", "16", "n"}));
  command
      .add_option("--name", options->names,
                  "name of the grid, once for each volume; not for .vdb and .nvdb, whose grids have names [density; of "
                  "several, the stems of the file names]")
      ->allow_extra_args(false);
  command
      .add_option("--unit", options->units,
                  "unit of the values, kept as value_unit in the metadata of the grid; once, or once for each input "
                  "[none]")
      ->allow_extra_args(false);
  command.add_option("--grid", options->gridName,
                     "of a .vdb or .nvdb: only this grid, \"name\" or \"name[1]\" [all scalar ones]");
  command.add_option(
      "--series", options->series,
      "of a DICOM folder: the UID of a series, or its number in the list that is printed [the only one]");
  const CLI::Validator autoOrFinite(
      [](const std::string& value) { return value == "auto" ? std::string() : finiteNumber()(value); }, "");
  command
      .add_option("--background", options->background,
                  "value of what is left out, grid units; auto: the value that most voxels on the faces of the volume "
                  "have, for which the input is read once before [0, or that of the .vdb or .nvdb]")
      ->check(autoOrFinite);
  CLI::Option* tolerance =
      command
          .add_option("--tolerance", options->build.tolerance,
                      "leave out voxels this close to the background and merge what is this close, grid units")
          ->check(nonNegativeNumber())
          ->capture_default_str();
  CLI::Option* threshold = command
                               .add_option("--threshold", options->threshold,
                                           "voxels at and below this value become background, grid units [none]")
                               ->check(finite);
  CLI::Option* clipBelow = command
                               .add_option("--clip-below", options->build.clipBelow,
                                           "as --threshold, but voxels at the value itself stay, grid units [none]")
                               ->check(finite)
                               ->excludes(threshold);
  CLI::Option* range =
      command
          .add_option(
              "--range", options->range,
              "lowest and highest value that stay, both included; the rest becomes background, grid units [all]")
          ->check(finite)
          ->excludes(threshold, clipBelow);
  command.add_option(
      "--mask", options->mask,
      "a volume of the same size and place, or a .vdb: voxels where it is 0 become background; headerless "
      "raw has the same --dims");
  command.add_option("--mask-type", options->maskType, "of a voxel of a headerless mask, as --type")
      ->check(voxelType())
      ->capture_default_str();
  command.add_option(
      "--crop", options->crop,
      "only the voxels from x0 y0 z0 to x1 y1 z1, both included; they stay where they are in the world; of a .vdb or "
      ".nvdb by its indices");
  command
      .add_option(
          "--resample", options->resample,
          "spacing of the voxels to be made, one for all axes or one for each, world units (mm, where the file states "
          "its unit): each has the mean of what it covers, so that the integral stays; the last ones along an axis may "
          "reach beyond the volume and have the mean of their part inside; stands behind the input [as in the file]")
      ->expected(1, 3)
      ->check(positiveNumber());
  CLI::Option* half = command.add_flag("--half", options->build.half, "save 16-bit floats; their error counts");
  CLI::Option* step = command
                          .add_option("--step", options->build.step,
                                      "round values to multiples of this, grid units, so that they pack better; best "
                                      "a power of two [not rounded]")
                          ->check(positiveNumber());
  CLI::Option* maxError =
      command
          .add_option(
              "--max-error", options->build.maxError,
              "no voxel that is kept or left out by tolerance is off by more, grid units: picks tolerance, half "
              "floats and steps, or with --quantise n tolerance and bits")
          ->check(nonNegativeNumber())
          ->excludes(tolerance, half, step);
  CLI::Option* verify =
      command.add_flag("--verify", options->verify,
                       "read the file back before it takes its name and compare it with the input; if it is worse than "
                       "stated, exit 1 and write nothing");
  CLI::Option* plan =
      command
          .add_flag(
              "--plan", options->plan,
              "write nothing (-o is not needed): tell from a tenth of the volume, or all of a small one, how many "
              "voxels become active, and how large the grid, a .vdb of --codec and the memory to convert it are, "
              "each with its 95 % confidence; the rest is skipped, but for --background auto, which reads all")
          ->excludes(verify);
  CLI::Option* isosurface =
      command
          .add_option("--isosurface", options->isosurface,
                      "write the surface where the volume has this value, grid units, as a level set: signed distance "
                      "in world units, negative where the value is this or more; it must be above the background, "
                      "which is what lies beyond the volume; voxels become cubes of the smallest spacing [none]")
          ->check(finite)
          ->excludes(tolerance, threshold, clipBelow, range, half, step, maxError, plan, verify);
  command.add_option("--half-width", options->halfWidth, "of the level set on each side of its surface, voxels")
      ->check(numberIn(1, 100, "1 to 100"))
      ->capture_default_str()
      ->needs(isosurface);

  command
      .add_option("--threads", options->threads, "that build leaves; one more reads [0: as many as there are cores]")
      ->check(CLI::Range(0, 4096));
  addRawOptions(command, options);
}

}  // namespace umbrick::tools
