// SPDX-License-Identifier: Apache-2.0
#include "frame_scenes.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <iostream>
#include <numbers>
#include <string>

#include "frame_samples.h"
#include "umbrick/core/error.h"
#include "umbrick/core/turned_camera.h"

namespace umbrick::tools {
namespace {

// More than a camera turns its picture from one frame to the next by intention, rad.
constexpr double kRoll = 1;

// What is percent of a volume's largest gradient is that of the first volume in all frames.
void fixGradients(Scene& scene, const Volume& volume) {
  if (scene.gradientUnit != GradientUnit::percent) return;
  const double percent = volume.largestGradient() / 100;
  scene.gradientUnit = GradientUnit::grid;
  scene.gradientOpacity *= percent;
  for (SceneTrack& track : scene.tracks)
    if (track.field == "gradientOpacity")
      for (SceneTrack::Key& key : track.keys)
        for (double& number : key.numbers) number *= percent;
}

// Refuses keys between which the scene becomes one that cannot be drawn.
void checkFrames(const Scene& scene, const FrameJob& job) {
  for (const FrameJob::Frame& frame : job.frames) try {
      validateScene(sceneAt(scene, static_cast<double>(frame.number)));
    } catch (const InvalidArgument& error) {
      throw InvalidArgument("frame " + std::to_string(frame.number) + ": " + error.what());
    }
}

}  // namespace

FrameScenes::FrameScenes(const OpenedScene& opened, const FrameJob& job, Technique technique, double orbit)
    : scene_(opened.scene),
      seen_(opened.seen),
      technique_(technique),
      first_(resolved(*opened.volume, static_cast<double>(job.frames.front().number))),
      oneVolume_(job.oneVolume),
      step_(static_cast<double>(job.step)),
      count_(static_cast<double>(job.frames.size())),
      centre_(first_.camera.lookAt),
      axis_(first_.camera.up),
      radians_(orbit * std::numbers::pi / 180) {
  if (scene_.orbit) {
    centre_ = (seen_ ? *seen_ : opened.volume->visibleBounds(*scene_.transfer)).centre();
    axis_ = orbitView(*scene_.orbit).up;
  }
  if (!haveKeys()) return;
  checkFrames(scene_, job);
  fixGradients(scene_, *opened.volume);
  tellRolls(job);
}

void FrameScenes::tellRolls(const FrameJob& job) const {
  if (scene_.orbit) return;
  std::optional<Camera> last;
  for (const FrameJob::Frame& frame : job.frames) {
    const Camera camera = sceneAt(scene_, static_cast<double>(frame.number)).camera;
    if (last && rollBetween(*last, camera) > kRoll) {
      std::cerr << "frame " << frame.number << ": the picture turns over, since the camera passes a view along its "
                << "up; keys of camera.up avoid that\n";
      return;
    }
    last = camera;
  }
}

ResolvedScene FrameScenes::resolved(const Volume& volume, double number) const {
  const Scene scene = sceneAt(scene_, number);
  const bool bySight = !seen_ && scene.orbit && scene.transfer;
  ResolvedScene resolved =
      bySight ? volume.resolve(scene) : volume.resolve(scene, seen_.value_or(volume.worldBounds()));
  resolved.technique = technique_;
  return resolved;
}

Camera FrameScenes::turned(const Camera& camera, double share) const {
  return turnedCamera(camera, centre_, axis_, share * radians_);
}

ResolvedScene FrameScenes::at(const FrameJob::Frame& frame, const Volume* volume) const {
  const auto number = static_cast<double>(frame.number);
  ResolvedScene scene = first_;
  if (volume && haveKeys())
    scene = resolved(*volume, number);
  else if (volume && !oneVolume_)
    scene.bricks.interior = resolved(*volume, number).bricks.interior;
  else if (haveKeys())
    scene.background = sceneAt(scene_, number).background;
  scene.camera = turned(scene.camera, frame.turn);
  scene.volume = frame.volume;
  if (volume) scene.volume.grid = volume->source().grid;
  return scene;
}

Camera FrameScenes::cameraAt(const FrameJob::Frame& frame, const Volume& volume, double share) const {
  const double number = static_cast<double>(frame.number) + share * step_;
  return turned(haveKeys() ? resolved(volume, number).camera : first_.camera, frame.turn + share / count_);
}

bool FrameScenes::leavesView(const Volume& volume) const {
  if (!seen_) return false;
  const auto leaves = [&](const Box& box) {
    const double rounding = 1e-6 * glm::length(seen_->extent());
    return glm::any(glm::lessThan(box.min, seen_->min - rounding)) ||
           glm::any(glm::greaterThan(box.max, seen_->max + rounding));
  };
  return leaves(volume.worldBounds()) && leaves(visibleAtAnyKey(volume, scene_));
}

}  // namespace umbrick::tools
