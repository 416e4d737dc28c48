// umbrick convert: a volume of any format that is read to a sparse .vdb, with the loss it cost.
// SPDX-License-Identifier: Apache-2.0
#include <tbb/global_control.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "convert_grids.h"
#include "convert_options.h"
#include "convert_sequence.h"
#include "convert_source.h"
#include "convert_volumes.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/ingest/open_volume.h"
#include "umbrick/vdb/read_grid.h"

namespace umbrick::tools {
namespace {
namespace fs = std::filesystem;

// What of the options is for a file of grids.
GridInput gridInput(const ConvertOptions& options) {
  const auto refuse = [&](bool given, const char* option, const char* why) {
    if (given) throw UsageError(options.input.string() + ": " + option + " is for volumes: " + why);
  };
  refuse(options.background == "auto", "--background auto", "a grid states its background; give a number to change it");
  refuse(!options.resample.empty(), "--resample", "a grid keeps its voxels");
  refuse(options.plan, "--plan", "of a grid umbrick info tells what it holds");
  refuse(!options.names.empty(), "--name", "grids have names");
  refuse(!options.units.empty(), "--unit", "grids keep their metadata");
  GridInput input{options.input, {}, options.build, {}, {}, options.verify, {}};
  if (options.isosurface) input.isosurface = {*options.isosurface, options.halfWidth};
  if (!options.allGrids) input.grid = options.gridName;
  if (options.crop) input.crop = cropBox(options);
  if (options.mask.empty()) return input;
  input.mask = [options] {
    if (holdsGrids(options.mask)) return readScalarGrid(options.mask);
    BuildOptions asItIs;
    asItIs.name = options.mask.string();
    return ScalarGrid{buildGrid(*openMask(options), asItIs).grid, asItIs.name};
  };
  return input;
}

// @return whether the input is a file of grids  @throw UsageError
bool readsGrids(const ConvertOptions& options) {
  bool grids = false;
  for (const fs::path& input : options.inputs) {
    const std::string extension = input.extension().string();
    const auto named =
        extension == ".vdb" || extension == ".nvdb" ? std::optional<std::string>(extension) : formatOfName(input);
    if (options.raw() && named)
      throw UsageError(input.string() + ": --dims and --type are for headerless raw, not for " + *named);
    grids = grids || (!options.raw() && holdsGrids(input));
    if (grids && options.inputs.size() > 1)
      throw UsageError(input.string() + ": expected volumes where there are several inputs, found a file of grids");
  }
  return grids;
}

Outcome convertFrames(const ConvertOptions& options, const std::vector<FrameFiles>& frames) {
  if (options.raw() || !holdsGrids(frames.front().input)) return convertVolumeFrames(options, frames);
  const auto input = [&](std::size_t i) { return gridInput(frameOptions(options, frames[i])); };
  return convertGridFrames(frames, options.output, input, *options.bar);
}

int convert(ConvertOptions options) {
  const Stopwatch stopwatch;
  settleOptions(options);
  std::optional<tbb::global_control> limit;
  if (options.threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
  const StopRequest stop;
  ProgressBar bar("converting");
  options.bar = &bar;
  options.build.progress = [&](double share) {
    if (stop.requested())
      throw Error(options.plan ? options.input.string() + ": interrupted"
                               : options.output.path.string() + ": interrupted before it was written");
    bar.show(share);
  };
  const bool grids = readsGrids(options);
  options.input = options.inputs.front();
  if (options.plan) {
    if (grids) gridInput(options);
    planVolumes(options);
    return 0;
  }
  const std::vector<FrameFiles> frames = findFrames(options);
  const Outcome outcome = !frames.empty() ? convertFrames(options, frames)
                          : grids         ? convertGrids(gridInput(options), options.output)
                                          : convertVolumes(options);
  std::cout << options.output.path.string() << ": ";
  if (!frames.empty()) std::cout << frames.size() << (frames.size() == 1 ? " frame, " : " frames, ");
  std::cout << outcome.bytesIn << " bytes in, " << outcome.bytesOut << " bytes out, "
            << std::lround(stopwatch.elapsedMs()) << " ms\n";
  return 0;
}

}  // namespace

Command addConvert(CLI::App& app) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = app.add_subcommand(
      "convert",
      "Turn volumes of many formats, a .vdb or a .nvdb into a sparse .vdb or another format; prints what was lost.");
  addConvertOptions(*command, options);
  return {command, [command, options] {
            options->allGrids = command->count("--grid") == 0;
            options->hasSpacing = command->count("--spacing") > 0;
            options->hasOrigin = command->count("--origin") > 0;
            return convert(*options);
          }};
}

}  // namespace umbrick::tools
