// What is chosen for a scene once its volume is known.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <numbers>

#include "umbrick/core/camera.h"
#include "umbrick/core/short_number.h"
#include "umbrick/grid/value_survey.h"
#include "umbrick/render/asked_scene.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {

void chooseTransfer(const AskedScene& asked, const SceneHints& hints, const Volume& volume, CompletedScene& completed) {
  Scene& scene = completed.scene;
  if (scene.transfer) {
    const TransferFunction fitting = fitted(*scene.transfer, volume);
    if (fitting != *scene.transfer)
      completed.reasons.push_back("the transfer function, made for values in " + scene.transfer->unit() +
                                  ", is shifted to " + fitting.unit());
    scene.transfer = fitting;
    for (SceneTrack& track : scene.tracks)
      for (SceneTrack::Key& key : track.keys)
        if (key.transfer) key.transfer = fitted(*key.transfer, volume);
    return;
  }
  const SuggestedTransfer suggested = hints.transfer ? *hints.transfer : suggestTransfer(volume);
  scene.transfer = suggested.transfer;
  applyWindow(asked, scene);
  completed.chosen.emplace_back("tf", "auto");
  completed.reasons.push_back(suggested.reason);
}

// Completes the surfaces of a scene: a level set has one where it is 0.
void chooseSurfaces(const AskedScene& asked, const Volume& volume, CompletedScene& completed) {
  Scene& scene = completed.scene;
  if (!traitsOf(scene.mode).surfaces || !scene.surfaces.empty()) return;
  if (volume.grid().isLevelSet()) {
    scene.surfaces = {SceneSurface{}};
    completed.chosen.emplace_back("iso", "0");
    return;
  }
  const Range values = surveyValues(volume.grid()).value;
  throw AskedSceneError(asked.nameOf("mode") + ' ' + modeName(scene.mode) + ": needs " + asked.nameOf("iso") +
                        " with the value of the surface, between " + shortNumber(values.min, 6) + " and " +
                        shortNumber(values.max, 6));
}

// Returns how many kelvin a unit of values is that are no temperatures: the largest is about 2000 K.
double fittingScale(double largest) { return 2000 / std::max(1.0, std::round(largest)); }

// Returns the intensity by which rays through the brighter columns of what emits add a luminance of 2.
double fittingIntensity(const ScalarGrid& second, EmissionSettings settings) {
  settings.intensity = 1;
  const TransferFunction function = emissionFunction(settings);
  const auto luminance = [&](double value) {
    return glm::dot(function(value).sigma_s(), glm::dvec3(0.2126, 0.7152, 0.0722));
  };
  double brightest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> columns = columnIntegrals(second, axis, luminance);
    if (columns.empty()) continue;
    const auto bright = columns.begin() + static_cast<std::ptrdiff_t>(columns.size() * 9 / 10);
    std::ranges::nth_element(columns, bright);
    brightest += *bright / 3;
  }
  constexpr double kBright = 2;
  return brightest > 0 ? kBright / brightest : 1;
}

// Completes what emits light: its unit, and how bright it is.
void chooseEmission(const AskedScene& asked, const Volume& volume, CompletedScene& completed) {
  Scene& scene = completed.scene;
  if (!emits(scene) || !volume.grid().emission) return;
  const std::string& name = scene.volume.emissionGrid;
  completed.chosen.emplace_back("emission-grid", "'" + name + "'");
  ScalarGrid second;
  second.grid = volume.grid().emission;
  const double largest = surveyValues(second).value.max;
  EmissionSettings& emission = scene.emission;
  const auto rounded = [](double number) { return std::strtod(shortNumber(number, 3).c_str(), nullptr); };
  constexpr double kDraper = 798;  // K, see emission.h
  if (emission.kind == EmissionKind::blackBody && largest > 0 && emission.scale * largest + emission.offset < kDraper) {
    const double fitting = rounded(fittingScale(largest));
    const std::string is = "values of \"" + name + "\" up to " + shortNumber(largest, 4);
    if (!asked.whole && !asked.has("emission-scale") && !asked.has("emission-offset")) {
      emission.scale = fitting;
      completed.chosen.emplace_back("emission-scale", shortNumber(fitting, 6));
      completed.reasons.push_back(is + " are no kelvin: " + shortNumber(fitting, 6) + " K a unit");
    } else {
      completed.reasons.push_back(is + " are " + shortNumber(emission.scale * largest + emission.offset, 4) +
                                  " K, and nothing glows below 798 K: " + asked.nameOf("emission-scale") + ' ' +
                                  shortNumber(fitting, 6) + " would fit");
    }
  }
  if (asked.whole && !scene.background && !asked.has("background"))
    completed.reasons.push_back("without a background a PNG shows what emits only where smoke is");
  if (asked.whole) return;
  if (!asked.has("emission-intensity")) {
    emission.intensity = rounded(fittingIntensity(second, emission));
    completed.chosen.emplace_back("emission-intensity", shortNumber(emission.intensity, 6));
  }
  if (!asked.has("background") && !scene.background) {
    scene.background = glm::dvec3(0);
    completed.chosen.emplace_back("background", "0 0 0");
  }
}

void chooseView(const AskedScene& asked, const SceneHints& hints, const Volume& volume, CompletedScene& completed) {
  Scene& scene = completed.scene;
  if (!scene.orbit) return;
  const Orientation& orientation = volume.orientation();
  if (asked.view) {
    try {
      scene.orbit = namedView(*asked.view, *scene.orbit, orientation);
    } catch (const InvalidArgument& error) {
      throw AskedSceneError(asked.nameOf("view") + std::string(error.what()).substr(std::string_view("view").size()));
    }
  }
  const auto add = [&](const char* option, const std::string& value) { completed.chosen.emplace_back(option, value); };
  const bool up = scene.orbit->up != Axis::automatic, front = scene.orbit->front != Axis::automatic;
  scene.orbit = settledOrbit(*scene.orbit, orientation);
  if (!up) {
    add("up", std::string(nameOf(kAxes, scene.orbit->up)));
    if (!front && scene.orbit->front != usualFront(scene.orbit->up))
      add("front", std::string(nameOf(kAxes, scene.orbit->front)));
    if (orientation.up != Axis::z || orientation.anatomy) completed.reasons.push_back(orientation.reason);
  }
  if (!asked.whole && !asked.has("zoom") && !asked.has("azimuth") && !asked.has("elevation")) {
    // A view that nobody has turned fills the picture.
    const Box bounds = hints.seen ? *hints.seen : volume.visibleBounds(*scene.transfer);
    const double zoom = fillingZoom(orbitCamera(bounds, orbitView(*scene.orbit), scene.camera), bounds);
    scene.orbit->zoom = std::strtod(shortNumber(zoom, 3).c_str(), nullptr);
    add("zoom", shortNumber(zoom, 3));
  }
  if (asked.whole || asked.view || asked.has("azimuth") || asked.has("elevation")) return;
  completed.view = true;
  add("azimuth", shortNumber(scene.orbit->azimuth * 180 / std::numbers::pi, 6));
  add("elevation", shortNumber(scene.orbit->elevation * 180 / std::numbers::pi, 6));
}

}  // namespace

CompletedScene completedScene(const AskedScene& asked, Scene scene, const Volume& volume, const SceneHints& hints) {
  CompletedScene completed{.scene = std::move(scene), .chosen = {}, .reasons = volume.notes()};
  if (completed.scene.volume.grid != volume.source().grid)
    completed.chosen.emplace_back("grid", "'" + volume.source().grid + "'");
  completed.scene.volume = volume.source();
  chooseTransfer(asked, hints, volume, completed);
  chooseSurfaces(asked, volume, completed);
  chooseEmission(asked, volume, completed);
  if (!asked.whole && !asked.has("model") && traitsOf(completed.scene.model).directions) {
    completed.chosen.emplace_back("model", modelName(completed.scene.model));
    if (!asked.quality && traitsOf(completed.scene.method).directions)
      completed.chosen.emplace_back("quality", "normal");
  }
  chooseView(asked, hints, volume, completed);
  return completed;
}

}  // namespace umbrick
