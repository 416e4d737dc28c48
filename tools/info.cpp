// umbrick info tells what is in a file: a volume of any format, or grids.
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "command.h"
#include "info_grids.h"
#include "info_volume.h"
#include "opened_scene.h"
#include "umbrick/convert/holds_grids.h"

namespace umbrick::tools {
namespace {
namespace fs = std::filesystem;

struct InfoOptions {
  fs::path input;
  std::vector<std::string> grids;  // only these; empty: all
  int bins = 16;
  bool json = false, suggestTransfer = false;
  VolumeOptions volume;
};

int info(const InfoOptions& options) {
  if (options.suggestTransfer) {
    if (options.grids.size() > 1)
      throw UsageError("--suggest-tf: expected one --grid, found " + std::to_string(options.grids.size()));
    VolumeOptions volume = options.volume;
    if (!options.grids.empty()) volume.grid = options.grids.front();
    std::cout << printTransferFunction(suggestFor(options.input, volume).transfer) << '\n';
    return 0;
  }
  // Headerless raw has no name or first bytes that say what it is.
  if (options.volume.dims.empty() && options.volume.type.empty() && holdsGrids(options.input))
    printGridInfo(options.input, options.grids, options.bins, options.json);
  else
    printVolumeInfo(options.input, options.volume, options.bins, options.json);
  return 0;
}

}  // namespace

Command addInfo(CLI::App& app) {
  const auto options = std::make_shared<InfoOptions>();
  CLI::App* command = app.add_subcommand(
      "info", "Describe a volume of any format that convert reads, or every grid of a .vdb or .nvdb (NanoVDB) file.");
  command
      ->add_option(
          "file", options->input,
          "a volume, told by its name or first bytes (convert --list-formats), headerless raw (--dims, --type), "
          "or a .vdb or .nvdb file")
      ->required();
  command->add_option("--bins", options->bins, "of the histogram of the values, of a grid of the active ones")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  command->add_flag("--json", options->json, "JSON instead of text");
  command->add_flag("--suggest-tf", options->suggestTransfer,
                    "print the transfer function that --tf auto makes, of a volume of any format");
  addVolumeOptions(*command, options->volume);
  // Several grids are described, of which a picture would show one.
  command->remove_option(command->get_option("--grid"));
  command
      ->add_option("--grid", options->grids,
                   "of a file of grids: only this one, \"name\" or \"name[1]\"; may be repeated [all]")
      ->allow_extra_args(false)
      ->group("Volume");
  return {command, [options] { return info(*options); }};
}

}  // namespace umbrick::tools
