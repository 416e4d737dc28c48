// The options of what a picture shows: its mode and its isosurfaces.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "opened_scene.h"
#include "scene_options.h"

namespace umbrick::tools {

/// Adds --iso, --iso-colours and --iso-opacity.
void addSurfaceOptions(CLI::App& command, SceneOptions& options);

/// Makes the surfaces of a scene. @throw UsageError  there are more colours or opacities than values; values for a mode
/// that has no surfaces
void applySurfaces(const SceneOptions& options, Scene& scene);

/// Completes the surfaces of a scene whose volume is known: a level set has one where it is 0.
/// @return what was chosen, as an option's value; empty: nothing
/// @throw UsageError  surfaces are asked for, but not which
std::string chooseSurfaces(Scene& scene, const Volume& volume);

/// Prints which options mean nothing to a scene's mode. @param layers  those of an EXR are asked for
void tellUnusedByMode(const SceneOptions& options, const SceneSettings& scene, bool layers);

}  // namespace umbrick::tools
