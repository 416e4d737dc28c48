// Fields in bricks and pictures for tests of the renderer.
#pragma once
#include <utility>

#include "support/field_bricks.h"
#include "support/gl_fixture.h"
#include "support/test_scenes.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/shade/prepare.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick {

/// A field in bricks as the scene needs them.
inline FieldBricks fieldFor(const Scene& scene, FieldBricks::Field field, const IndexBox& box,
                            FieldOptions options = {}) {
  options.interior = scene.bricks.interior;
  options.apron = requiredApron(scene, options.indexToWorld);
  options.gradients = scene.transfer->is2d();
  return FieldBricks(std::move(field), box, options);
}

inline Picture renderPicture(const GlContext& context, const Bricks& volume, const Scene& scene,
                             const RenderOptions& options = {}) {
  return SliceRenderer(context, volume, scene, options).render();
}

}  // namespace umbrick
