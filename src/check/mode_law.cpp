// SPDX-License-Identifier: Apache-2.0
#include "check/mode_law.h"

#include <algorithm>
#include <cmath>

#include "check/picture_difference.h"
#include "check/result.h"
#include "umbrick/draw/value_picture.h"
#include "umbrick/render/techniques.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/shade/prepare.h"

namespace umbrick {
namespace {

// Returns a value in the middle of the function's, or else of the volume's.
double surfaceValue(const ResolvedScene& scene, const Range& values) {
  const Range domain = scene.transfer.valueDomain();
  const double middle = 0.5 * (static_cast<double>(domain.min) + static_cast<double>(domain.max));
  if (middle >= values.min && middle < values.max) return middle;
  return 0.5 * (static_cast<double>(values.min) + static_cast<double>(values.max));
}

ResolvedScene movedBy(const ResolvedScene& scene, const glm::dvec3& shift) {
  ResolvedScene moved = scene;
  moved.camera.eye += shift;
  moved.camera.lookAt += shift;
  return moved;
}

}  // namespace

void ModeLaw::prepare(const ResolvedScene& scene) {
  if (bricks_) return;
  BrickOptions options = bricksOf(volume_, scene, volume_.sceneEdge);
  options.apron = std::max(options.apron, kGradientApron);
  bricks_ = cutGrid(volume_.grid, options, true);
  resident_ = std::make_unique<ResidentVolume>(context_, *bricks_, atlasOptions(scene, *bricks_));
  onGl_ = traitsOf(Technique::rays).makeOnGl(*resident_, scene, {});
  onCpu_ = traitsOf(Technique::rays).makeOnCpu(*bricks_, scene, {});
}

Image ModeLaw::drawn(Renderer& renderer, const ResolvedScene& scene) const {
  renderer.setScene(scene);
  Picture picture = renderer.render();
  if (!traitsOf(scene.mode).projection) return std::move(picture.colour);
  Image values = std::move(std::ranges::find(picture.layers, "value", &ImageLayer::name)->image);
  const double extent = static_cast<double>(bricks_->value.max) - static_cast<double>(bricks_->value.min);
  if (traitsOf(scene.mode).ofValues && extent > 0)
    for (float& value : values.pixels) value = static_cast<float>(value / extent);
  return values;
}

// Single precision moves places by some 2^-22 of the volume. What the picture changes by where it is moved a hundredth
// of a voxel tells what that may do: where pictures are smooth the change is in proportion, and where surfaces end it
// is the number of pixels, so that the root of its mean square falls with the root of the distance.
double ModeLaw::limitOf(const ResolvedScene& scene, const Image& onGl, const Image& onCpu) {
  constexpr double kMoved = 0.01;
  const glm::dvec3 extent(bricks_->domain.extent());
  const double places = 0x1p-22 * std::max({64.0, extent.x, extent.y, extent.z});
  const glm::dvec3 shift = glm::dmat3(bricks_->indexToWorld) * glm::dvec3(kMoved);
  double limit =
      rmsDifference(onCpu, drawn(*onCpu_, movedBy(scene, shift))) * std::sqrt(std::min(1.0, places / kMoved)) + 0x1p-18;
  if (!traitsOf(scene.mode).medium && traitsOf(scene.mode).surfaces) return limit;
  ResolvedScene finer = scene;
  finer.sampling.spacing /= 2;
  return limit + 2 * (rmsDifference(onGl, drawn(*onGl_, finer)) + rmsDifference(onCpu, drawn(*onCpu_, finer)));
}

void ModeLaw::check(const ResolvedScene& scene, const std::string& where, InvariantResult& result) {
  ResolvedScene there = scene;
  there.technique = Technique::rays;
  there.model = Model::emission;
  there.sampling.saturation = 0;
  there.bricks.culling = true;
  prepare(there);
  for (const ModeTraits& traits : modeTraits()) {
    if (traits.mode == Mode::integrate) continue;
    const std::string name = where + ": rays in the mode " + modeName(traits.mode);
    steps_.begin(name, kWork / static_cast<double>(modeTraits().size() - 1));
    there.mode = traits.mode;
    there.surfaces.clear();
    if (traits.surfaces) {
      if (!(bricks_->value.min < bricks_->value.max)) continue;
      there.surfaces = {SceneSurface{surfaceValue(there, bricks_->value), {}, traits.medium ? 0.5 : 1.0}};
    }
    const Image onGl = drawn(*onGl_, there), onCpu = drawn(*onCpu_, there);
    const auto pixels = static_cast<std::size_t>(there.camera.width) * static_cast<std::size_t>(there.camera.height);
    addMeasurement(result, rmsDifference(onGl, onCpu), limitOf(there, onGl, onCpu), pixels, name);
  }
}

}  // namespace umbrick
