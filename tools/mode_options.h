// The options of what a picture shows: its mode, its isosurfaces and its mesh.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "scene_options.h"

namespace umbrick::tools {

/// Adds --iso, --iso-colours and --iso-opacity.
void addSurfaceOptions(CLI::App& command, SceneOptions& options);

/// Adds --mesh.
void addMeshOption(CLI::App& command, SceneOptions& options);

/// Prints which options mean nothing to a scene's mode. @param layers  those of an EXR are asked for
void tellUnusedByMode(const SceneOptions& options, const SceneSettings& scene, bool layers);

}  // namespace umbrick::tools
