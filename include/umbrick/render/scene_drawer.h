// What draws a volume whose scene changes in every way: engine, bricks and renderer, which stay as long as they fit.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>

#include "umbrick/draw/renderer.h"
#include "umbrick/render/engine.h"
#include "umbrick/render/volume.h"

namespace umbrick {

class SceneDrawer {
 public:
  /// @param volume   outlives this with whoever shares it
  /// @param refined  bricks are cut for pictures whose samples become finer, see renderProgressive
  /// @param chosen   is called with each engine, once it is known what draws; may be empty
  SceneDrawer(std::shared_ptr<const Volume> volume, EngineKind kind, RenderOptions options, bool refined,
              std::function<void(const Engine& engine)> chosen = {});
  ~SceneDrawer();

  /// Returns a renderer that has the scene. It is the one before, which uploads no more than what the change asks for,
  /// unless the scene needs another engine or other bricks.
  /// @throw InvalidArgument, GlError, IoError  as chooseEngine, Volume::cut and Renderer::setScene
  /// @pre   on the thread that made the renderer before, if one draws by OpenGL
  Renderer& rendererFor(const ResolvedScene& scene);

  /// Draws another volume from now on, with the same engine as long as that fits the scene.
  /// @param volume  null: rendererFor() may not be called
  void open(std::shared_ptr<const Volume> volume);

  /// @pre rendererFor() once
  const Engine& engine() const;
  const Bricks& bricks() const;

 private:
  struct Parts;
  void make(const ResolvedScene& scene);

  std::shared_ptr<const Volume> volume_;
  EngineKind kind_;
  RenderOptions options_;
  bool refined_;
  std::function<void(const Engine& engine)> chosen_;
  std::unique_ptr<Parts> parts_;
};

}  // namespace umbrick
