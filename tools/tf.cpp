// umbrick tf lists transfer functions and makes one for a volume.
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <memory>

#include "command.h"
#include "opened_scene.h"
#include "output_option.h"
#include "transfer_sheet.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/image/png.h"
#include "umbrick/optics/transfer_function.h"

namespace umbrick::tools {
namespace {
namespace fs = std::filesystem;

struct TfOptions {
  fs::path input, output, sheet;
  bool force = false;
  VolumeOptions volume;
  std::string spacing;
};

int list(TfOptions options) {
  if (!options.sheet.empty() && pictureFormat(options.sheet, "") != "png")
    throw UsageError(options.sheet.string() + ": expected a picture that ends in .png");
  prepareOutput(options.sheet, options.force);
  for (const std::string& name : transferPresets())
    std::cout << name << std::string(name.size() < 14 ? 14 - name.size() : 1, ' ') << describeTransferFunction(name)
              << '\n';
  if (options.sheet.empty()) return 0;
  writePng(options.sheet, drawTransferSheet(transferPresets()));
  if (!isStream(options.sheet)) std::cout << shownName(options.sheet) << '\n';
  return 0;
}

int suggest(TfOptions options) {
  if (!options.spacing.empty()) {
    const auto numbers = parseNumbers(options.spacing);
    if (!numbers || numbers->size() != 3)
      throw UsageError("--spacing: expected three numbers, found '" + options.spacing + "'");
    options.volume.spacing = numbers;
  }
  prepareOutput(options.output, options.force);
  const std::string text = printTransferFunction(suggestFor(options.input, options.volume).transfer) + "\n";
  if (options.output.empty()) {
    std::cout << text;
    return 0;
  }
  writeTextFile(options.output, text);
  if (!isStream(options.output)) std::cout << shownName(options.output) << '\n';
  return 0;
}

}  // namespace

Command addTf(CLI::App& app) {
  const auto options = std::make_shared<TfOptions>();
  CLI::App* sub = app.add_subcommand("tf", "List transfer functions, or make one that fits a volume.");
  sub->require_subcommand(1);
  CLI::App* listing = sub->add_subcommand("list", "List the presets, with what they are for.");
  listing->add_option("-o,--output", options->sheet, "draw them into this .png, too; - for stdout");
  addForceOption(*listing, options->force);
  CLI::App* making = sub->add_subcommand("auto", "Make the function that --tf auto uses, to be edited.");
  making->add_option("input", options->input, "a volume of any format that convert reads, a .vdb or .nvdb")->required();
  making->add_option("-o,--output", options->output, "the .json to write [stdout]");
  addForceOption(*making, options->force);
  addVolumeOptions(*making, options->volume);
  making->add_option("--spacing", options->spacing, "of the voxels of a volume whose file states none, three numbers")
      ->group("Volume");
  return {sub, [options, listing] { return listing->parsed() ? list(*options) : suggest(*options); }};
}

}  // namespace umbrick::tools
