// A grid as rays on OpenGL draw it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "sweep/value_picture.h"
#include "umbrick/shade/ray_caster.h"

namespace umbrick {

/// @param layers  visibility and depth are kept, too
inline Picture castGrid(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene,
                        bool layers = false, const AtlasLimits& limits = {}) {
  RenderOptions options;
  options.visibilityAndDepth = layers;
  const auto volume = valueBricks(grid, scene);
  return RayCaster(context, *volume, scene, options, limits).render();
}

}  // namespace umbrick
