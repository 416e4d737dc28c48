// SPDX-License-Identifier: Apache-2.0
#include "mode_options.h"

#include <iostream>

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

void addMeshOption(CLI::App& command, SceneOptions& options) {
  command
      .add_option(
          "--mesh", options.mesh,
          "opaque geometry in the volume: .ply, .obj or .stl, world units; hides what lies behind it, is shaded "
          "by --shading and --shading-light, casts shadows into the volume where --model has any and gets none, and is "
          "not clipped; drawn by rays")
      ->group("Mesh");
}

void tellUnusedByMode(const SceneOptions& options, const SceneSettings& scene, bool layers) {
  if (!traitsOf(scene.mode).medium)
    for (const char* option : {"gradient-opacity", "gradient-unit"})
      if (options.has(option))
        std::cerr << options.nameOf(option) << " has no effect on the mode " << modeName(scene.mode)
                  << ", which shows no medium\n";
  if (!traitsOf(scene.mode).projection) return;
  const auto tell = [&](const std::string& option) {
    std::cerr << option << " has no effect on the mode " << modeName(scene.mode) << '\n';
  };
  for (const char* option : {"model", "method", "theta", "directions", "ambient"})
    if (options.has(option)) tell(options.nameOf(option));
  if (layers)
    std::cerr << "--layers: a picture of the mode " << modeName(scene.mode)
              << " has neither V nor Z, and its layer value in any case\n";
}

}  // namespace umbrick::tools
