// Pictures in one call: the front door for programs that need no more.
//
//   umbrick::Scene scene;
//   scene.volume.file = "head.nii.gz";  // or any other volume, or a file of grids
//   scene.model = umbrick::Model::cone;
//   umbrick::writePng("head.png", umbrick::renderScene(scene).colour);
//
// Without a transfer function one that fits the volume is suggested (suggest_transfer.h).
//
// A program that draws a volume more than once keeps the parts: a Volume (volume.h), its Bricks, a ResidentVolume
// (atlas/resident_volume.h) and a Renderer (techniques.h), whose scene is changed by setters.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string_view>

#include "umbrick/gl/context.h"
#include "umbrick/render/techniques.h"
#include "umbrick/render/volume.h"

namespace umbrick {

/// Loads the scene's volume and renders it.
/// @param context  current; null: one is made for this picture
/// @throw IoError, InvalidArgument, GlError
Picture renderScene(const Scene& scene, const RenderOptions& options = {}, const GlContext* context = nullptr,
                    std::string_view technique = {});

/// The parts that are needed to look at a volume, in one object: bricks, their textures and a renderer.
class VolumeView {
 public:
  /// Cuts the volume for the scene and makes it resident.
  /// @param context,volume  outlive this; the context is current
  /// @throw InvalidArgument, IoError, GlError
  VolumeView(const GlContext& context, const Volume& volume, const Scene& scene, const RenderOptions& options = {},
             std::string_view technique = {});

  const Bricks& bricks() const { return *bricks_; }
  ResidentVolume& resident() { return resident_; }
  /// Returns the renderer. Its scene is changed by setters, see Renderer.
  Renderer& renderer() { return *renderer_; }
  Picture render(const RenderSample& sample = {}) { return renderer_->render(sample); }

 private:
  VolumeView(const GlContext& context, const Volume& volume, const ResolvedScene& scene, const RenderOptions& options,
             std::string_view technique);

  std::unique_ptr<Bricks> bricks_;
  ResidentVolume resident_;
  std::unique_ptr<Renderer> renderer_;
};

}  // namespace umbrick
