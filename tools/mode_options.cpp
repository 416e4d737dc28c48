// SPDX-License-Identifier: Apache-2.0
#include "mode_options.h"

#include <iostream>

#include "command.h"
#include "umbrick/core/short_number.h"
#include "umbrick/grid/value_survey.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick::tools {

void addSurfaceOptions(CLI::App& command, SceneOptions& options) {
  const std::string group = "Mode";
  command
      .add_option(
          "--iso", options.isoValues,
          "of isosurface and hybrid: the value of the surface, or several, separated by commas [of a level set: 0]")
      ->type_size(1)
      ->allow_extra_args(false)
      ->delimiter(',')
      ->group(group);
  command
      .add_option(
          "--iso-colours,--iso-colors", options.isoColours,
          "of isosurface and hybrid: r g b, linear, of the first surface; repeated for the next ones [as the transfer "
          "function has at its value]")
      ->type_size(3)
      ->group(group);
  command
      .add_option("--iso-opacity", options.isoOpacities,
                  "of isosurface and hybrid: 0 to 1, one for all surfaces or one each, separated by commas [1]")
      ->type_size(1)
      ->allow_extra_args(false)
      ->delimiter(',')
      ->group(group);
}

void applySurfaces(const SceneOptions& options, Scene& scene) {
  const bool given = !options.isoValues.empty() || !options.isoColours.empty() || !options.isoOpacities.empty();
  if (!given) return;
  if (!traitsOf(scene.mode).surfaces)
    throw UsageError("--iso, --iso-colours and --iso-opacity are for --mode isosurface and hybrid, found " +
                     modeName(scene.mode));
  if (!options.isoValues.empty()) {
    scene.surfaces.assign(options.isoValues.size(), SceneSurface{});
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i) scene.surfaces[i].value = options.isoValues[i];
  }
  // A level set has a surface of its own.
  if (scene.surfaces.empty()) scene.surfaces.resize(1);
  const std::size_t count = scene.surfaces.size();
  const auto tooMany = [&](const char* option, std::size_t found) {
    throw UsageError(std::string(option) + ": expected " + std::to_string(count) +
                     (count == 1 ? ", as there is one surface" : ", as many as there are surfaces") + ", found " +
                     std::to_string(found));
  };
  if (options.isoColours.size() > count) tooMany("--iso-colours", options.isoColours.size());
  if (options.isoOpacities.size() > 1 && options.isoOpacities.size() != count)
    tooMany("--iso-opacity", options.isoOpacities.size());
  for (std::size_t i = 0; i < options.isoColours.size(); ++i) {
    const std::vector<double>& c = options.isoColours[i];
    scene.surfaces[i].colour = glm::dvec3(c[0], c[1], c[2]);
  }
  if (options.isoOpacities.empty()) return;
  for (std::size_t i = 0; i < count; ++i)
    scene.surfaces[i].opacity = options.isoOpacities[options.isoOpacities.size() == 1 ? 0 : i];
}

std::string chooseSurfaces(Scene& scene, const Volume& volume) {
  if (!traitsOf(scene.mode).surfaces || !scene.surfaces.empty()) return {};
  if (volume.grid().isLevelSet()) {
    scene.surfaces = {SceneSurface{}};
    return "0";
  }
  const Range values = surveyValues(volume.grid()).value;
  throw UsageError("--mode " + modeName(scene.mode) + ": needs --iso with the value of the surface, between " +
                   shortNumber(values.min, 6) + " and " + shortNumber(values.max, 6));
}

void tellUnusedByMode(const SceneOptions& options, const SceneSettings& scene, bool layers) {
  if (!traitsOf(scene.mode).medium)
    for (const char* option : {"gradient-opacity", "gradient-unit"})
      if (options.has(option))
        std::cerr << options.nameOf(option) << " has no effect on the mode " << modeName(scene.mode)
                  << ", which shows no medium\n";
  if (scene.mode == Mode::integrate || scene.mode == Mode::hybrid) return;
  const auto tell = [&](const std::string& option) {
    std::cerr << option << " has no effect on the mode " << modeName(scene.mode) << '\n';
  };
  const bool lit = isShaded(scene) && traitsOf(scene.model).sources;
  if (options.has("model") && !lit) tell(options.nameOf("model"));
  for (const char* option : {"method", "theta", "directions"})
    if (options.has(option)) tell(options.nameOf(option));
  if (options.has("ambient") && traitsOf(scene.mode).projection) tell(options.nameOf("ambient"));
  if (layers && traitsOf(scene.mode).projection)
    std::cerr << "--layers: a picture of the mode " << modeName(scene.mode)
              << " has neither V nor Z, and its layer value in any case\n";
}

}  // namespace umbrick::tools
