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

#include "umbrick/gl/context.h"
#include "umbrick/render/engine.h"
#include "umbrick/render/volume.h"

namespace umbrick {

/// Loads the scene's volume and renders it, where chooseEngine() says.
/// @param context  current: it is rendered there; null: a context is made if one is needed
/// @throw IoError, InvalidArgument, GlError
Picture renderScene(const Scene& scene, const RenderOptions& options = {}, const GlContext* context = nullptr);

/// The parts that are needed to look at a volume, in one object: bricks, their textures and a renderer.
class VolumeView {
 public:
  /// Cuts the volume for the scene and makes it resident on OpenGL.
  /// @param context,volume  outlive this; the context is current
  /// @throw InvalidArgument, IoError, GlError
  VolumeView(const GlContext& context, const Volume& volume, const Scene& scene, const RenderOptions& options = {});
  /// Cuts the volume for a scene that is rendered on the CPU.
  /// @throw InvalidArgument, IoError
  VolumeView(const Volume& volume, const Scene& scene, const RenderOptions& options = {});

  const Bricks& bricks() const { return *bricks_; }
  /// @pre on OpenGL
  ResidentVolume& resident() { return *resident_; }
  /// Returns the renderer. Its scene is changed by setters, see Renderer.
  Renderer& renderer() { return *renderer_; }
  Picture render(const RenderSample& sample = {}) { return renderer_->render(sample); }

 private:
  VolumeView(const GlContext& context, const Volume& volume, const ResolvedScene& scene, const RenderOptions& options);
  VolumeView(const Volume& volume, const ResolvedScene& scene, const RenderOptions& options);

  std::unique_ptr<Bricks> bricks_;
  std::unique_ptr<ResidentVolume> resident_;  // none on the CPU
  std::unique_ptr<Renderer> renderer_;
};

}  // namespace umbrick
