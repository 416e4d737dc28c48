// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/render.h"

#include "umbrick/shade/prepare.h"

namespace umbrick {

VolumeView::VolumeView(const GlContext& context, const Volume& volume, const Scene& scene, const RenderOptions& options,
                       std::string_view technique)
    : VolumeView(context, volume, volume.resolve(scene), options, technique) {}

VolumeView::VolumeView(const GlContext& context, const Volume& volume, const ResolvedScene& scene,
                       const RenderOptions& options, std::string_view technique)
    : bricks_(volume.cut(scene)),
      resident_(context, *bricks_, atlasOptions(scene, *bricks_)),
      renderer_(makeRenderer(resident_, scene, options, technique)) {}

Picture renderScene(const Scene& scene, const RenderOptions& options, const GlContext* context,
                    std::string_view technique) {
  const Volume volume(scene.volume);
  std::unique_ptr<GlContext> own;
  if (!context) own = createGlContext();
  return VolumeView(context ? *context : *own, volume, scene, options, technique).render();
}

}  // namespace umbrick
