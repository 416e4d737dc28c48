// The techniques of rendering, and where each runs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <span>
#include <string_view>

#include "umbrick/atlas/resident_volume.h"
#include "umbrick/draw/renderer.h"

namespace umbrick {

/// What is known of a technique. Its name is that of kTechniques.
struct TechniqueTraits {
  Technique technique;
  std::string_view meaning;  // "proxy slices across the view, nearest first"
  /// Makes a renderer on OpenGL; null: it runs on the CPU alone. @throw InvalidArgument, GlError
  std::unique_ptr<Renderer> (*makeOnGl)(ResidentVolume& volume, const ResolvedScene& scene,
                                        const RenderOptions& options);
  /// Makes a renderer on the CPU; null: it runs on OpenGL alone. @throw InvalidArgument
  std::unique_ptr<Renderer> (*makeOnCpu)(const Bricks& volume, const ResolvedScene& scene,
                                         const RenderOptions& options);
  /// Tells whether it can render the scene.
  bool (*supports)(const SceneSettings& scene);
};

/// Returns all techniques.
std::span<const TechniqueTraits> techniques();
/// @pre not Technique::automatic
const TechniqueTraits& traitsOf(Technique technique);

/// Makes a renderer that lives as long as its volume is looked at, of the scene's technique; where that is automatic,
/// of the first one that runs there and can render the scene.
/// @param volume  outlives the renderer
/// @throw InvalidArgument  the scene's technique does not run there; or as the renderer's constructor
/// @throw GlError
/// @pre the context of `volume` is current
std::unique_ptr<Renderer> makeRenderer(ResidentVolume& volume, const ResolvedScene& scene,
                                       const RenderOptions& options = {});
std::unique_ptr<Renderer> makeRenderer(const Bricks& volume, const ResolvedScene& scene,
                                       const RenderOptions& options = {});

}  // namespace umbrick
