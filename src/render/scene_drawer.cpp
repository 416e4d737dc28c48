// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/scene_drawer.h"

#include <optional>
#include <utility>

#include "umbrick/atlas/resident_volume.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/shade/prepare.h"
#include "umbrick/sweep/swept_bricks.h"

namespace umbrick {
namespace {

// What a renderer and its bricks are made for: another one needs them anew.
struct MadeFor {
  Technique technique;
  std::optional<Method> method;
  Model model;
  std::optional<GradientFilter> gradients;  // of bricks; none: they have none
  int apron;                                // that techniques on the CPU need
  bool byAll;  // techniques can render the mode and its shading; else another one may have to be chosen
  BrickSettings bricks;
  bool operator==(const MadeFor&) const = default;
  // Whether the same engine draws both.
  bool sameEngine(MadeFor other) const {
    other.bricks = bricks;
    return *this == other;
  }
};
MadeFor madeFor(const ResolvedScene& scene) {
  return {scene.technique,
          occlusionMethod(scene),
          scene.model,
          scene.transfer.is2d() ? std::optional(scene.gradients) : std::nullopt,
          sweptBricks(scene).apron,
          supportsMode(scene, Technique::slices) && supportsMode(scene, Technique::shearWarp),
          scene.bricks};
}

}  // namespace

struct SceneDrawer::Parts {
  MadeFor key;
  Engine engine;
  std::unique_ptr<Bricks> bricks;
  std::unique_ptr<ResidentVolume> resident;  // none on the CPU
  std::unique_ptr<Renderer> renderer;        // null: no volume is cut

  // A renderer points to the bricks, and these to their volume.
  void release() {
    renderer.reset();
    resident.reset();
    bricks.reset();
  }
};

SceneDrawer::SceneDrawer(std::shared_ptr<const Volume> volume, EngineKind kind, RenderOptions options, bool refined,
                         std::function<void(const Engine& engine)> chosen)
    : volume_(std::move(volume)),
      kind_(kind),
      options_(std::move(options)),
      refined_(refined),
      chosen_(std::move(chosen)) {}

SceneDrawer::~SceneDrawer() = default;

void SceneDrawer::open(std::shared_ptr<const Volume> volume) {
  if (parts_) parts_->release();
  volume_ = std::move(volume);
}

// Cuts the volume and makes the renderer, with the engine that there is if it fits.
void SceneDrawer::make(const ResolvedScene& scene) {
  const MadeFor key = madeFor(scene);
  if (parts_ && !parts_->key.sameEngine(key)) parts_.reset();
  const bool other = !parts_;
  if (other) parts_ = std::make_unique<Parts>(Parts{key, chooseEngine(scene, kind_), {}, {}, {}});
  parts_->release();
  parts_->key = key;
  ResolvedScene decided = scene;
  decided.technique = parts_->engine.technique;
  if (parts_->engine.context) {
    parts_->bricks = refined_ ? volume_->cutForRefinement(decided) : volume_->cut(decided);
    parts_->resident = std::make_unique<ResidentVolume>(*parts_->engine.context, *parts_->bricks,
                                                        atlasOptions(decided, *parts_->bricks));
    parts_->renderer = makeRenderer(*parts_->resident, decided, options_);
  } else {
    parts_->bricks = volume_->cutForCpu(decided);
    parts_->renderer = makeRenderer(*parts_->bricks, decided, options_);
  }
  if (other && chosen_) chosen_(parts_->engine);
}

Renderer& SceneDrawer::rendererFor(const ResolvedScene& scene) {
  if (!parts_ || !parts_->renderer || parts_->key != madeFor(scene)) {
    make(scene);
    return *parts_->renderer;
  }
  ResolvedScene decided = scene;
  decided.technique = parts_->engine.technique;
  // Slabs that reach beyond the apron need other bricks.
  if (parts_->renderer->sampling(decided))
    parts_->renderer->setScene(decided);
  else
    make(scene);
  return *parts_->renderer;
}

const Engine& SceneDrawer::engine() const { return parts_->engine; }
const Bricks& SceneDrawer::bricks() const { return *parts_->bricks; }

}  // namespace umbrick
