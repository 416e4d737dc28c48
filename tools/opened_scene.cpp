// SPDX-License-Identifier: Apache-2.0
#include "opened_scene.h"

#include <iostream>
#include <string>

#include "command.h"
#include "option_words.h"
#include "umbrick/core/printable.h"

namespace umbrick::tools {
namespace {

std::string lineOf(const CompletedScene& completed) {
  std::string line = printable(completed.scene.volume.file.string()) + ":";
  for (const auto& [option, value] : completed.chosen) line += " --" + option + ' ' + value;
  const bool both = !completed.chosen.empty() && !completed.reasons.empty();
  for (std::size_t i = 0; i < completed.reasons.size(); ++i)
    line += (i > 0 ? "; " : both ? " (" : " ") + printable(completed.reasons[i]);
  return line + (both ? ")\n" : "\n");
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
  CompletedScene completed = asUsage([&] { return completedScene(options, std::move(scene), *volume, hints); });
  OpenedScene opened{.scene = {}, .volume = std::move(volume), .seen = hints.seen};
  if (completed.matters()) opened.chosen = lineOf(completed);
  opened.scene = std::move(completed.scene);
  return opened;
}

}  // namespace umbrick::tools
