// The scene that pages look at: it changes by patches, and every change can be undone.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "umbrick/render/volume.h"
#include "umbrick/scene/scene.h"

namespace umbrick::view {

/// Changes that can be undone; older ones are forgotten.
inline constexpr std::size_t kMostSteps = 200;
/// The step of patches that follow the size of a page's window: they are not undone.
inline constexpr std::string_view kSizeStep = "size";
/// Pixels along an edge of a picture that a page may ask for.
inline constexpr int kMostPixels = 4096;

class ViewState {
 public:
  /// @param scene  with a transfer function, as openScene() completes it. An orbit is one around what that function
  ///   shows from now on, so that the camera stays where pages edit the function
  /// @param seen  what orbits turn around instead, world units: of a volume that is a frame of a sequence
  /// @throw InvalidArgument  it fits the volume not
  ViewState(Scene scene, std::shared_ptr<const Volume> volume, const std::optional<Box>& seen = {});

  const Scene& scene() const { return scene_; }
  const ResolvedScene& resolved() const { return *resolved_; }
  const Volume& volume() const { return *volume_; }
  const std::shared_ptr<const Volume>& share() const { return volume_; }
  /// The scene as pages edit it.
  nlohmann::ordered_json json() const;
  /// The same with the camera in place of an orbit: as a file it makes the same picture, by umbrick render.
  Scene placed() const;

  /// Merges a patch (RFC 7396) into the scene. A patch reads no files: a transfer function is named by a preset or
  /// "auto", or is given itself, and the volume stays.
  /// @param step  patches of one step, such as those of a drag, are undone together; empty: a step of its own
  /// @throw InvalidArgument, IoError  the scene would not be a valid one; it stays as it was
  void edit(const nlohmann::ordered_json& patch, const std::string& step = {});
  bool canUndo() const { return !undo_.empty(); }
  bool canRedo() const { return !redo_.empty(); }
  void undo();  // does nothing where there is nothing to undo; so does redo()
  void redo();
  /// Goes back to the scene that it began with, which can be undone.
  void reset();

  /// Looks at another frame of a sequence: the scene and all that can be undone stay, but for the volume's name.
  /// @param volume  null: the frame holds nothing, and scenes are those of the volume before
  /// @param source  what the scene names from now on
  /// @throw InvalidArgument  the scene does not fit the volume; the frame before stays
  void show(const std::shared_ptr<const Volume>& volume, const VolumeReference& source);
  /// The scene of all frames of a sequence: placed(), with what was in units of this frame's own in those of the grid.
  Scene placedIn(const VolumeReference& sequence) const;

 private:
  std::unique_ptr<ResolvedScene> resolve(const Scene& scene) const { return resolve(scene, *volume_); }
  std::unique_ptr<ResolvedScene> resolve(const Scene& scene, const Volume& volume) const;
  Scene patched(const nlohmann::ordered_json& patch) const;
  void take(Scene scene, const std::string& step);

  std::shared_ptr<const Volume> volume_;
  Box seen_;  // what orbits turn around, world units
  Scene scene_, first_;
  std::unique_ptr<ResolvedScene> resolved_;
  std::deque<Scene> undo_;
  std::vector<Scene> redo_;
  std::string step_;
  mutable std::optional<double> surface_;  // suggestSurface(), once somebody has asked for it
};

}  // namespace umbrick::view
