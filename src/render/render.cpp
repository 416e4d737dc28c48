// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/render.h"

#include "umbrick/shade/prepare.h"

namespace umbrick {

VolumeView::VolumeView(const GlContext& context, const Volume& volume, const Scene& scene, const RenderOptions& options)
    : VolumeView(context, volume, volume.resolve(scene), options) {}

VolumeView::VolumeView(const Volume& volume, const Scene& scene, const RenderOptions& options)
    : VolumeView(volume, volume.resolve(scene), options) {}

VolumeView::VolumeView(const GlContext& context, const Volume& volume, const ResolvedScene& scene,
                       const RenderOptions& options)
    : bricks_(volume.cut(scene)),
      resident_(std::make_unique<ResidentVolume>(context, *bricks_, atlasOptions(scene, *bricks_))),
      renderer_(makeRenderer(*resident_, scene, options)) {}

VolumeView::VolumeView(const Volume& volume, const ResolvedScene& scene, const RenderOptions& options)
    : bricks_(volume.cutForCpu(scene)), renderer_(makeRenderer(*bricks_, scene, options)) {}

Picture renderScene(const Scene& scene, const RenderOptions& options, const GlContext* context) {
  const Volume volume(scene.volume);
  if (context) return VolumeView(*context, volume, scene, options).render();
  Scene decided = scene;
  const Engine engine = chooseEngine(scene);
  decided.technique = engine.technique;
  return engine.context ? VolumeView(*engine.context, volume, decided, options).render()
                        : VolumeView(volume, decided, options).render();
}

}  // namespace umbrick
