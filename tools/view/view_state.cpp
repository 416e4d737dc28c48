// SPDX-License-Identifier: Apache-2.0
#include "view/view_state.h"

#include <algorithm>
#include <utility>

#include "umbrick/core/error.h"
#include "umbrick/render/suggest_transfer.h"
#include "umbrick/scene/capabilities.h"
#include "view/surface_value.h"

namespace umbrick::view {
namespace {

using Json = nlohmann::ordered_json;

// A transfer function by the name of a file would read that file. Keys name functions, too, and a page has no frames
// for them.
void refuseFiles(const Json& patch) {
  if (!patch.is_object()) throw InvalidArgument("patch: is no object");
  if (patch.contains("volume")) throw InvalidArgument("volume: a page cannot change it");
  if (const auto mesh = patch.find("mesh"); mesh != patch.end() && mesh->is_object() && mesh->contains("file"))
    throw InvalidArgument("mesh.file: a page cannot change it");
  const auto refuseKeys = [](const Json& section) {
    if (section.is_object() && section.contains("keys")) throw InvalidArgument("keys: a page cannot set them");
  };
  refuseKeys(patch);
  for (const Json& section : patch) refuseKeys(section);
  const auto transfer = patch.find("transfer");
  if (transfer == patch.end() || !transfer->is_string()) return;
  const auto name = transfer->get<std::string>();
  const std::vector<std::string> presets = transferPresets();
  if (name != "auto" && std::find(presets.begin(), presets.end(), name) == presets.end())
    throw InvalidArgument("transfer: '" + name.substr(0, 80) + "' is no preset");
}

}  // namespace

ViewState::ViewState(Scene scene, std::shared_ptr<const Volume> volume, const std::optional<Box>& seen)
    : volume_(std::move(volume)),
      seen_(seen ? *seen : volume_->visibleBounds(*scene.transfer)),
      scene_(std::move(scene)) {
  if (scene_.orbit) scene_.orbit = settledOrbit(*scene_.orbit, volume_->orientation());
  first_ = scene_;
  resolved_ = resolve(scene_);
}

std::unique_ptr<ResolvedScene> ViewState::resolve(const Scene& scene, const Volume& volume) const {
  return std::make_unique<ResolvedScene>(volume.resolve(scene, seen_));
}

Scene ViewState::placed() const {
  Scene scene = scene_;
  scene.camera = resolved_->camera;
  scene.orbit.reset();
  return scene;
}

Json ViewState::json() const { return Json::parse(printScene(scene_)); }

Scene ViewState::patched(const Json& patch) const {
  refuseFiles(patch);
  Json whole = json();
  whole.erase("volume");
  // Lights that no patch touches may come from a file that a patch could not name.
  const bool sameLights =
      !patch.contains("light") || !patch["light"].is_object() || !patch["light"].contains("sources");
  if (sameLights && whole.contains("light")) whole["light"].erase("sources");
  if (whole.contains("mesh")) whole["mesh"].erase("file");
  whole.merge_patch(patch);
  Scene next = parseScene(whole.dump(), "edit", {}, true);
  if (sameLights) next.lights = scene_.lights;
  next.volume = scene_.volume;
  next.mesh.file = scene_.mesh.file;
  next.mesh.shape = scene_.mesh.shape;
  if (next.camera.width > kMostPixels || next.camera.height > kMostPixels)
    throw InvalidArgument("camera.size: is " + std::to_string(next.camera.width) + " x " +
                          std::to_string(next.camera.height) + ", a page shows up to " + std::to_string(kMostPixels));
  if (!next.transfer)
    next.transfer = suggestTransfer(*volume_).transfer;
  else if (next.transfer->unit() != scene_.transfer->unit())
    next.transfer = fitted(*next.transfer, *volume_);  // looks at the whole volume
  if (next.orbit) next.orbit = settledOrbit(*next.orbit, volume_->orientation());
  // A page that asks for surfaces sees one, whose value it can change.
  if (traitsOf(next.mode).surfaces && next.surfaces.empty()) {
    if (!surface_) surface_ = suggestSurface(volume_->grid());  // looks at the whole volume
    next.surfaces = {SceneSurface{*surface_}};
  }
  // Surfaces take light from a light volume alone.
  if (traitsOf(next.mode).surfaces && traitsOf(next.model).occlusion && !patch.contains("method"))
    next.method = Method::lightVolume;
  return next;
}

void ViewState::take(Scene scene, const std::string& step) {
  auto resolved = resolve(scene);
  // A window that takes another size is no edit.
  if (step != kSizeStep && (step.empty() || step != step_ || undo_.empty())) {
    undo_.push_back(scene_);
    if (undo_.size() > kMostSteps) undo_.pop_front();
  }
  if (step != kSizeStep) {
    step_ = step;
    redo_.clear();
  }
  scene_ = std::move(scene);
  resolved_ = std::move(resolved);
}

void ViewState::edit(const Json& patch, const std::string& step) {
  Scene next = patched(patch);
  if (next == scene_) return;
  take(std::move(next), step);
}

void ViewState::undo() {
  if (undo_.empty()) return;
  auto resolved = resolve(undo_.back());
  redo_.push_back(std::exchange(scene_, undo_.back()));
  undo_.pop_back();
  resolved_ = std::move(resolved);
  step_.clear();
}

void ViewState::redo() {
  if (redo_.empty()) return;
  auto resolved = resolve(redo_.back());
  undo_.push_back(std::exchange(scene_, redo_.back()));
  redo_.pop_back();
  resolved_ = std::move(resolved);
  step_.clear();
}

void ViewState::reset() {
  if (scene_ != first_) take(first_, {});
}

void ViewState::show(const std::shared_ptr<const Volume>& volume, const VolumeReference& source) {
  Scene scene = scene_;
  scene.volume = source;
  auto resolved = resolve(scene, volume ? *volume : *volume_);
  resolved_ = std::move(resolved);
  if (volume) volume_ = volume;
  for (Scene* each : {&scene_, &first_}) each->volume = source;
  for (Scene& each : undo_) each.volume = source;
  for (Scene& each : redo_) each.volume = source;
}

Scene ViewState::placedIn(const VolumeReference& sequence) const {
  Scene scene = placed();
  scene.volume = sequence;
  scene.gradientOpacity = resolved_->gradientOpacity;
  scene.gradientUnit = GradientUnit::grid;
  return scene;
}

}  // namespace umbrick::view
