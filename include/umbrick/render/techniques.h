// Finds the techniques of rendering by their names.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <span>
#include <string_view>

#include "umbrick/atlas/resident_volume.h"
#include "umbrick/draw/renderer.h"

namespace umbrick {

struct Technique {
  std::string_view name;     // "slices"
  std::string_view meaning;  // what help says about it
  /// Makes a renderer. @param volume  outlives the renderer  @throw InvalidArgument, GlError
  std::unique_ptr<Renderer> (*make)(ResidentVolume& volume, const ResolvedScene& scene, const RenderOptions& options);
};

/// Returns all techniques; the first one is used where none is named.
std::span<const Technique> techniques();

/// Makes a renderer that lives as long as its volume is looked at.
/// @param technique  its name; empty: the first one
/// @throw InvalidArgument  there is no such technique (the message lists those there are); or as the
///   renderer's constructor
/// @throw GlError
/// @pre the context of `volume` is current
std::unique_ptr<Renderer> makeRenderer(ResidentVolume& volume, const ResolvedScene& scene,
                                       const RenderOptions& options = {}, std::string_view technique = {});

}  // namespace umbrick
