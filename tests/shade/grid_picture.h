// Pictures of a grid, cut into bricks as the scene needs them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "shade/shade_fixture.h"
#include "support/test_grids.h"
#include "umbrick/brick/brick_grid.h"

namespace umbrick {

inline std::unique_ptr<Bricks> bricksFor(const ScalarGrid& grid, const ResolvedScene& scene) {
  BrickOptions options;
  options.interior = scene.bricks.interior;
  options.apron = requiredApron(scene, grid.indexToWorld());
  options.gradients = scene.transfer.is2d();
  options.gradientFilter = scene.gradients;
  return brickGrid(grid, options);
}

inline Picture renderGrid(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene,
                          const RenderOptions& options = {}) {
  return renderPicture(context, *bricksFor(grid, scene), scene, options);
}

}  // namespace umbrick
