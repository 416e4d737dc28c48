// A scene from the command line together with its volume, and what is chosen where neither says anything.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "scene_options.h"
#include "umbrick/render/suggest_transfer.h"
#include "umbrick/render/volume.h"

namespace umbrick::tools {

struct OpenedScene {
  Scene scene;  // with a transfer function, and with the axes of its orbit
  std::shared_ptr<const Volume> volume;
  /// What was chosen, as options that repeat it, and why: a line for stderr, or nothing. Is printed once it is clear
  /// that there will be a picture.
  std::string chosen = {};
  /// Of a sequence: the box that the camera looks at, see SceneHints.
  std::optional<Box> seen = {};
  std::size_t frame = 0;  // of a sequence: which one the volume is, counted from 0
};

/// Loads the volume of a scene that makeScene() made and completes the scene.
/// @param progress  as Volume has it
/// @throw UsageError, IoError, InvalidArgument
OpenedScene openScene(const SceneOptions& options, Scene scene, const std::function<void(double)>& progress = {});

/// Completes the scene for a volume that is loaded.
OpenedScene completeScene(const SceneOptions& options, Scene scene, std::shared_ptr<const Volume> volume,
                          const SceneHints& hints = {});

/// Loads a volume; messages name options. @throw UsageError, IoError, InvalidArgument
std::shared_ptr<const Volume> openVolumeOf(const VolumeReference& reference,
                                           const std::function<void(double)>& progress = {});

/// Makes the transfer function of --tf auto for a volume, and says on stderr what the volume is taken for.
/// @throw UsageError, IoError, InvalidArgument
SuggestedTransfer suggestFor(const std::filesystem::path& input, const VolumeOptions& options);

}  // namespace umbrick::tools
