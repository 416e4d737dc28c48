// SPDX-License-Identifier: Apache-2.0
#include "convert_options.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "command.h"
#include "convert_source.h"
#include "formats.h"
#include "label_words.h"
#include "output_option.h"
#include "umbrick/core/names.h"
#include "umbrick/ingest/frame_sequence.h"
#include "umbrick/ingest/open_volume.h"
#include "validators.h"
#include "volume_options.h"

namespace umbrick::tools {
namespace {
namespace fs = std::filesystem;

constexpr Name<VdbCodec> kCodecs[] = {{"blosc", VdbCodec::blosc}, {"zip", VdbCodec::zip}, {"none", VdbCodec::none}};
constexpr Name<NanoValues> kQuantise[] = {
    {"4", NanoValues::bits4}, {"8", NanoValues::bits8}, {"16", NanoValues::bits16}, {"n", NanoValues::adaptive}};

void addRawOptions(CLI::App& app, const std::shared_ptr<ConvertCommand>& command) {
  const std::string raw = "Headerless raw";
  app.add_option("--dims", command->dims, "voxels along x (fastest), y and z")->expected(3)->group(raw);
  app.add_option("--type", command->type, "of a voxel: u8, i8, u16, i16, u32, i32, i64, u64, f16, f32, f64")
      ->check(voxelType())
      ->group(raw);
  app.add_option("--components", command->components, "numbers of a voxel, side by side")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->group(raw);
  app.add_option("--endian", command->endian, "little or big")
      ->check(CLI::IsMember({"little", "big"}))
      ->capture_default_str()
      ->group(raw);
  app.add_option("--header-bytes", command->headerBytes, "to skip at the start, after unpacking")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->group(raw);
  app.add_option("--bits-stored", command->bitsStored, "of an integer; bits above are masked off [all]")
      ->check(CLI::PositiveNumber)
      ->group(raw);
  app.add_option("--spacing", command->spacing,
                 "world units between voxel centres along x, y, z; also of other formats that state none [1 1 1]")
      ->group(raw);
  app.add_option("--origin", command->origin,
                 "world position of the centre of voxel (0, 0, 0); also of other formats that state none [0 0 0]")
      ->group(raw);
}

// What is read and written.
void addFileOptions(CLI::App& app, const std::shared_ptr<ConvertCommand>& command) {
  app.add_option("input", command->inputs,
                 "a volume, told by its name or first bytes (--list-formats), or headerless raw (--dims, --type); "
                 "several become grids of one file, numbered ones (frame_%04d.nrrd) a file each, where the output is "
                 "numbered too")
      ->required();
  addListFormats(app);
  app.add_option(
      "--frames", command->frames,
      "of a sequence, where input and output have a number in their names (frame_%04d.nrrd, out_%04d.vdb), or "
      "the input is one file of several volumes (4D NIfTI, NRRD, MetaImage, HDF5, .npy), counted from 0: A, A-B or "
      "A-B:step [all there are]");
  app.add_option("--frame", command->frame, "of one file of several volumes: only this one, counted from 0");
  app.add_option("-o,--output", command->output,
                 "the file to write: .vdb, .nvdb (NanoVDB), or the dense box of the active voxels, up to 16 GiB, as "
                 ".nrrd or as .mhd with a .raw beside it, in the type of the input if it holds all values, else as "
                 "32-bit float; - for stdout");
  app.add_option("--format", command->format,
                 "of an output whose name does not end in one of these, such as - (stdout): vdb, nvdb or nrrd [vdb]")
      ->check(CLI::IsMember({"vdb", "nvdb", "nrrd"}));
  addForceOption(app, command->force);
}

void addPackingOptions(CLI::App& app, const std::shared_ptr<ConvertCommand>& command) {
  app.add_option("--codec", command->codec, "of a .vdb: blosc, zip or none [blosc]")
      ->check(CLI::IsMember(listNames(kCodecs)));
  app.add_option("--quantise", command->quantise,
                 "of a .nvdb: bits of a value, between the smallest and the largest of its leaf: 4, 8, 16, or n, in "
                 "each leaf as few as keep --max-error; the loss is measured and printed [32-bit floats]")
      ->check(CLI::IsMember(listNames(kQuantise)));
}

void addTargetOptions(CLI::App& app, const std::shared_ptr<ConvertCommand>& command) {
  CLI::Option* to =
      app.add_option(
             "--to", command->target,
             "make a .vdb ready for blender, houdini, unreal or omniverse: its unit of length, the axis that is "
             "up there, a grid called density, and but for houdini values from 0 (the background, by default "
             "the border's) to 1 as half floats, with the inverse in the metadata; vectors turn along, in lengths of "
             "that unit, and are called velocity or vel, colours color or Cd; each change is said [none]")
          ->check(CLI::IsMember(listNames(kTargets)));
  app.add_option(
         "--up", command->up,
         "for --to: which axis of the input is up: x, y, z, -x, -y or -z [the patient's head; z of volumes, y of "
         "files of grids]")
      ->check(CLI::IsMember(listNames(kAxes)))
      ->needs(to);
}

// Which grids, and what they are called.
void addGridOptions(CLI::App& app, const std::shared_ptr<ConvertCommand>& command) {
  app.add_option("--name", command->options.names,
                 "name of the grid, once for each volume; not for .vdb and .nvdb, whose grids have names [density; of "
                 "several, the stems of the file names]")
      ->allow_extra_args(false);
  app.add_option("--unit", command->options.units,
                 "unit of the values, kept as value_unit in the metadata of the grid; once, or once for each input "
                 "[none]")
      ->allow_extra_args(false);
  app.add_option("--grid", command->options.grids,
                 "of a .vdb or .nvdb: only this grid, \"name\" or \"name[1]\"; may be repeated [all scalar ones]")
      ->allow_extra_args(false);
  app.add_option(
      "--series", command->options.source.open.series,
      "of a DICOM folder: the UID of a series, or its number in the list that is printed [the only one]; its damaged "
      "files and slices unlike most of the others are left out");
  app.add_option("--where", command->options.source.open.where,
                 "of DICOM: only slices whose tag has this value, as AcquisitionNumber=2 or 0018,0081=4.6; may be "
                 "repeated, and then all must hold [all slices]")
      ->allow_extra_args(false);
}

// What becomes of voxels of several numbers, and of labels.
void addPartsOptions(CLI::App& app, const std::shared_ptr<ConvertCommand>& command) {
  CLI::Option* component = app.add_option(
      "--component", command->component,
      "of voxels of several numbers: only one of them (0, 1, ..., x, y, z of a vector, r, g, b, a of a colour), "
      "magnitude, the length of the vector, or all, a grid of each (name_0, name_1, or name_r, name_g of a colour) "
      "[three numbers: one grid of vec3, v or Cd; else all]");
  app.add_option("--labels", command->labels,
                 "a volume of labels: a grid of each, which is 1 where the label is, called as the file calls it "
                 "(.seg.nrrd, DICOM segmentations) or label_3; or only those that are named, as 3,5,liver [all, if "
                 "nothing follows]")
      ->excludes(component);
}

// How the files of volumes are read.
void addReadingOptions(CLI::App& app, const std::shared_ptr<ConvertCommand>& command) {
  app.add_option(
         "--length-unit", command->options.source.open.lengthUnit,
         "unit of the world: nm, um, mm, cm, m, or file for the one that the file states; where it states none, "
         "its numbers are taken for this unit, and so are those of --spacing and --origin [mm, or smaller where voxels "
         "are too small for OpenVDB]")
      ->check(CLI::IsMember({"nm", "um", "mm", "cm", "m", "file"}));
  app.add_option("--space", command->space,
                 "which way the axes of the world point: lps (towards left, posterior and superior of a patient, as in "
                 "DICOM), ras (as in NIfTI) or file; of a file that does not say it, the numbers are taken for that "
                 "space; .mhd is written as lps always [file; of several inputs that of the first]")
      ->check(CLI::IsMember({"lps", "ras", "file"}));
  app.add_flag("--override", command->options.source.open.overridePlace,
               "--spacing and --origin also take the place of what the file states, in the unit of its world");
  app.add_flag("--beside-only", command->options.source.open.besideOnly, kBesideOnly);
  app.add_flag(
      "--strict", command->options.source.open.strict,
      "refuse files whose plain voxels are longer than the header (NRRD, MetaImage, NIfTI, .npy) or --dims and "
      "--type say, which else is only noted");
}

// Which values stay.
void addValueOptions(CLI::App& app, const std::shared_ptr<ConvertCommand>& command) {
  const CLI::Validator finite = finiteNumber();
  const CLI::Validator autoOrFinite(
      [](const std::string& value) { return value == "auto" ? std::string() : finiteNumber()(value); }, "");
  app.add_option("--background", command->background,
                 "value of what is left out, grid units; auto: the value that most voxels on the faces of the volume "
                 "have, for which the input is read once before [0, or that of the .vdb or .nvdb]")
      ->check(autoOrFinite);
  app.add_option("--tolerance", command->options.build.tolerance,
                 "leave out voxels this close to the background and merge what is this close, grid units")
      ->check(nonNegativeNumber())
      ->capture_default_str();
  CLI::Option* threshold = app.add_option("--threshold", command->threshold,
                                          "voxels at and below this value become background, grid units [none]")
                               ->check(finite);
  CLI::Option* clipBelow = app.add_option("--clip-below", command->options.build.clipBelow,
                                          "as --threshold, but voxels at the value itself stay, grid units [none]")
                               ->check(finite)
                               ->excludes(threshold);
  app.add_option("--range", command->range,
                 "lowest and highest value that stay, both included; the rest becomes background, grid units [all]")
      ->check(finite)
      ->excludes(threshold, clipBelow);
}

// Which voxels stay.
void addPartOptions(CLI::App& app, const std::shared_ptr<ConvertCommand>& command) {
  app.add_option("--mask", command->options.source.mask,
                 "a volume of the same size and place, or a .vdb: voxels where it is 0 become background; headerless "
                 "raw has the same --dims");
  app.add_option("--mask-type", command->maskType, "of a voxel of a headerless mask, as --type")
      ->check(voxelType())
      ->capture_default_str();
  app.add_option(
      "--crop", command->crop,
      "only the voxels from x0 y0 z0 to x1 y1 z1, both included; they stay where they are in the world; of a .vdb or "
      ".nvdb by its indices");
  app.add_option(
         "--resample", command->resample,
         "spacing of the voxels to be made, one for all axes or one for each, world units (mm where the file states "
         "its unit, see --length-unit): each has the mean of what it covers, so that the integral stays; the last ones "
         "along an axis may reach beyond the volume and have the mean of their part inside; DICOM slices that are "
         "missing or uneven are interpolated before; stands behind the input [as in the file]")
      ->expected(1, 3)
      ->check(positiveNumber());
}

// What else may be lost.
void addLossOptions(CLI::App& app, const std::shared_ptr<ConvertCommand>& command) {
  CLI::Option* half = app.add_flag("--half", command->options.build.half, "save 16-bit floats; their error counts");
  CLI::Option* step = app.add_option("--step", command->options.build.step,
                                     "round values to multiples of this, grid units, so that they pack better; best "
                                     "a power of two [not rounded]")
                          ->check(positiveNumber());
  app.add_option("--max-error", command->options.build.maxError,
                 "no voxel that is kept or left out by tolerance is off by more, grid units: picks tolerance, half "
                 "floats and steps, or with --quantise n tolerance and bits")
      ->check(nonNegativeNumber())
      ->excludes(app.get_option("--tolerance"), half, step);
}

void addJobOptions(CLI::App& app, const std::shared_ptr<ConvertCommand>& command) {
  CLI::Option* verify =
      app.add_flag("--verify", command->options.verify,
                   "read the file back before it takes its name and compare it with the input; if it is worse than "
                   "stated, exit 1 and write nothing");
  app.add_flag("--plan", command->plan,
               "write nothing (-o is not needed): tell from a tenth of the volume, or all of a small one, how many "
               "voxels become active, and how large the grid, a .vdb of --codec and the memory to convert it are, "
               "each with its 95 % confidence; the rest is skipped, but for --background auto, which reads all")
      ->excludes(verify);
}

// Excludes options that are declared before.
void addIsosurfaceOptions(CLI::App& app, const std::shared_ptr<ConvertCommand>& command) {
  CLI::Option* isosurface =
      app.add_option("--isosurface", command->isosurface,
                     "write the surface where the volume has this value, grid units, as a level set: signed distance "
                     "in world units, negative where the value is this or more; it must be above the background, "
                     "which is what lies beyond the volume; voxels become cubes of the smallest spacing [none]")
          ->check(finiteNumber());
  app.add_option("--half-width", command->halfWidth, "of the level set on each side of its surface, voxels")
      ->check(numberIn(1, 100, "1 to 100"))
      ->capture_default_str()
      ->needs(isosurface);
  for (const char* other : {"--tolerance", "--threshold", "--clip-below", "--range", "--half", "--step", "--max-error",
                            "--plan", "--verify"})
    isosurface->excludes(app.get_option(other));
}

// What the options that name values say.
void setLimits(const ConvertCommand& command, BuildOptions& build) {
  if (!command.background.empty() && command.background != "auto")
    build.background = static_cast<float>(std::strtod(command.background.c_str(), nullptr));
  // What lies at the threshold is left out: the smallest value that stays is the next one.
  if (command.threshold) build.clipBelow = std::nextafter(*command.threshold, std::numeric_limits<float>::infinity());
  if (!command.range) return;
  const auto [low, high] = *command.range;
  if (low > high) {
    std::ostringstream text;
    text << "--range: expected the lower limit first, found " << low << ' ' << high;
    throw UsageError(text.str());
  }
  build.clipBelow = low;
  build.clipAbove = high;
}

OutputOptions outputOptions(const ConvertCommand& command) {
  OutputOptions output;
  if (!command.codec.empty()) output.codec = parseName(kCodecs, command.codec, "--codec");
  if (!command.quantise.empty()) output.nano = NanoOptions{parseName(kQuantise, command.quantise, "--quantise")};
  if (!command.target.empty()) output.target = parseName(kTargets, command.target, "--to");
  if (!command.up.empty()) output.up = parseName(kAxes, command.up, "--up");
  if (!command.format.empty())
    output.format = '.' + command.format;
  else if (!command.output.empty() && isStream(command.output))
    output.format = ".vdb";
  output.creator = "umbrick " UMBRICK_VERSION;
  return output;
}

// A plan writes nothing, and all else needs an output.
void checkPlan(const ConvertCommand& command) {
  if (!command.plan && command.output.empty()) throw UsageError("--output is required");
  if (!command.plan) return;
  for (const fs::path& input : command.inputs)
    if (!command.frames.empty() || (isFramePattern(input) && (command.raw() || formatOfName(input) != "images")))
      throw UsageError("--plan: expected volumes, found a sequence: " + input.string() + "; name one of its frames");
}

}  // namespace

ConvertOptions settledOptions(const ConvertCommand& command) {
  checkPlan(command);
  ConvertOptions options = command.options;
  options.output = outputOptions(command);
  if (!command.output.empty()) checkOutput(command.output, options.output, command.inputs);
  setLimits(command, options.build);
  options.source = sourceOptions(command);
  options.eachComponent = command.component == "all";
  if (!command.labels.empty()) options.labels = labelChoice(command.labels);
  if (command.isosurface) options.isosurface = {*command.isosurface, command.halfWidth};
  return options;
}

void addConvertOptions(CLI::App& app, const std::shared_ptr<ConvertCommand>& command) {
  // In the order of the help.
  addFileOptions(app, command);
  addPackingOptions(app, command);
  addTargetOptions(app, command);
  addGridOptions(app, command);
  addPartsOptions(app, command);
  addReadingOptions(app, command);
  addValueOptions(app, command);
  addPartOptions(app, command);
  addLossOptions(app, command);
  addJobOptions(app, command);
  addIsosurfaceOptions(app, command);
  app.add_option("--threads", command->threads, "that build leaves; one more reads [0: as many as there are cores]")
      ->check(CLI::Range(0, 4096));
  addRawOptions(app, command);
}

}  // namespace umbrick::tools
