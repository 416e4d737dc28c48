// SPDX-License-Identifier: Apache-2.0
#include "opened_scene.h"

#include <cstdlib>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include "command.h"
#include "mode_options.h"
#include "option_words.h"
#include "umbrick/core/names.h"
#include "umbrick/core/printable.h"
#include "umbrick/core/short_number.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick::tools {
namespace {

// What was chosen: options that say it, and reasons for people.
struct Choices {
  std::vector<std::string> options, reasons;
  bool view = false;  // the direction of the view is among them
  void add(const std::string& option, const std::string& value) { options.push_back("--" + option + ' ' + value); }
  // Which way is up and how fine a picture is are told only beside a choice that users may want to change.
  bool matter() const { return view || !reasons.empty(); }
};

std::string lineOf(const VolumeReference& volume, const Choices& choices) {
  std::string line = printable(volume.file.string()) + ":";
  for (const std::string& option : choices.options) line += ' ' + option;
  const bool both = !choices.options.empty() && !choices.reasons.empty();
  for (std::size_t i = 0; i < choices.reasons.size(); ++i)
    line += (i > 0 ? "; " : both ? " (" : " ") + printable(choices.reasons[i]);
  return line + (both ? ")\n" : "\n");
}

void chooseTransfer(const SceneOptions& options, const SceneHints& hints, OpenedScene& opened, Choices& choices) {
  Scene& scene = opened.scene;
  if (scene.transfer) {
    const TransferFunction fitting = fitted(*scene.transfer, *opened.volume);
    if (fitting != *scene.transfer)
      choices.reasons.push_back("the transfer function, made for values in " + scene.transfer->unit() +
                                ", is shifted to " + fitting.unit());
    scene.transfer = fitting;
    for (SceneTrack& track : scene.tracks)
      for (SceneTrack::Key& key : track.keys)
        if (key.transfer) key.transfer = fitted(*key.transfer, *opened.volume);
    return;
  }
  const SuggestedTransfer suggested = hints.transfer ? *hints.transfer : suggestTransfer(*opened.volume);
  scene.transfer = suggested.transfer;
  applyWindow(options, scene);
  choices.add("tf", "auto");
  choices.reasons.push_back(suggested.reason);
}

void chooseView(const SceneOptions& options, bool fromScene, OpenedScene& opened, Choices& choices) {
  Scene& scene = opened.scene;
  if (!scene.orbit) return;
  const Orientation& orientation = opened.volume->orientation();
  if (options.view) {
    try {
      scene.orbit = namedView(*options.view, *scene.orbit, orientation);
    } catch (const InvalidArgument& error) {
      throw UsageError("--" + std::string(error.what()));
    }
  }
  const bool up = scene.orbit->up != Axis::automatic, front = scene.orbit->front != Axis::automatic;
  scene.orbit = settledOrbit(*scene.orbit, orientation);
  if (!up) {
    choices.add("up", std::string(nameOf(kAxes, scene.orbit->up)));
    if (!front && scene.orbit->front != usualFront(scene.orbit->up))
      choices.add("front", std::string(nameOf(kAxes, scene.orbit->front)));
    if (orientation.up != Axis::z || orientation.anatomy) choices.reasons.push_back(orientation.reason);
  }
  if (!fromScene && !options.has("zoom") && !options.has("azimuth") && !options.has("elevation")) {
    // A view that nobody has turned fills the picture.
    const Box bounds = opened.seen ? *opened.seen : opened.volume->visibleBounds(*scene.transfer);
    const double zoom = fillingZoom(orbitCamera(bounds, orbitView(*scene.orbit), scene.camera), bounds);
    scene.orbit->zoom = std::strtod(shortNumber(zoom, 3).c_str(), nullptr);
    choices.add("zoom", shortNumber(zoom, 3));
  }
  if (fromScene || options.view || options.has("azimuth") || options.has("elevation")) return;
  choices.view = true;
  choices.add("azimuth", shortNumber(scene.orbit->azimuth * 180 / std::numbers::pi, 6));
  choices.add("elevation", shortNumber(scene.orbit->elevation * 180 / std::numbers::pi, 6));
}

}  // namespace

std::shared_ptr<const Volume> openVolumeOf(const VolumeReference& reference,
                                           const std::function<void(double)>& progress) {
  return asUsage([&] { return std::make_shared<const Volume>(reference, progress); });
}

SuggestedTransfer suggestFor(const std::filesystem::path& input, const VolumeOptions& options) {
  VolumeReference reference;
  reference.file = input;
  applyVolumeOptions(options, reference);
  SuggestedTransfer suggested = suggestTransfer(*openVolumeOf(reference));
  std::cerr << printable(input.string() + ": " + suggested.reason) << '\n';
  return suggested;
}

OpenedScene openScene(const SceneOptions& options, Scene scene, const std::function<void(double)>& progress) {
  std::shared_ptr<const Volume> volume = openVolumeOf(scene.volume, progress);
  return completeScene(options, std::move(scene), std::move(volume));
}

OpenedScene completeScene(const SceneOptions& options, Scene scene, std::shared_ptr<const Volume> volume,
                          const SceneHints& hints) {
  const bool fromScene = options.input.extension() == ".json";
  OpenedScene opened{.scene = std::move(scene), .volume = std::move(volume), .seen = hints.seen};
  Choices choices;
  choices.reasons = opened.volume->notes();
  if (opened.scene.volume.grid != opened.volume->source().grid)
    choices.add("grid", "'" + opened.volume->source().grid + "'");
  opened.scene.volume = opened.volume->source();
  chooseTransfer(options, hints, opened, choices);
  if (const std::string iso = chooseSurfaces(opened.scene, *opened.volume); !iso.empty()) choices.add("iso", iso);
  if (!fromScene && !options.has("model") && traitsOf(opened.scene.model).directions) {
    choices.add("model", modelName(opened.scene.model));
    if (!options.quality && traitsOf(opened.scene.method).directions) choices.add("quality", "normal");
  }
  chooseView(options, fromScene, opened, choices);
  if (choices.matter()) opened.chosen = lineOf(opened.scene.volume, choices);
  return opened;
}

}  // namespace umbrick::tools
