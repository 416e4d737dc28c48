// Pictures of grids by techniques on the CPU.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>

#include "shade/hard_case.h"
#include "umbrick/brick/brick_grid.h"
#include "umbrick/sweep/shear_warp_renderer.h"

namespace umbrick {

inline std::unique_ptr<Bricks> cpuBricksFor(const ScalarGrid& grid, const ResolvedScene& scene) {
  BrickOptions options;
  options.interior = scene.bricks.interior;
  options.gradients = scene.transfer.is2d();
  return cutGrid(grid, options, scene.bricks.bricked);
}

inline Picture shearWarped(const ScalarGrid& grid, const ResolvedScene& scene, const RenderOptions& options = {},
                           std::optional<ShearWarpSampling> sampling = {}) {
  const auto bricks = cpuBricksFor(grid, scene);
  return ShearWarpRenderer(*bricks, scene, options, sampling).render();
}

/// Renders with so many rays and slices a voxel and with twice as many, and compares with the reference. The value
/// counts as linear between slices and the picture as cubic between rays, which are off by the square of the distance
/// where the field is smooth, and by its 1.5th power at kinks of trilinear fields: the remaining error is a third of
/// the change, or 0.55 of it, see checkAgainstReference of tests/shade/hard_case.h.
inline double checkShearWarp(const ScalarGrid& grid, const ResolvedScene& scene, double floor = 5e-5,
                             double mostChange = 8e-3, int perVoxel = 2) {
  const Image exact = renderReference(grid, scene).colour;
  const auto pictureOf = [&](int each) {
    return shearWarped(grid, scene, {}, ShearWarpSampling{each, static_cast<double>(each)}).colour;
  };
  const Image coarse = pictureOf(perVoxel), fine = pictureOf(2 * perVoxel);
  const double change = rmsDifference(coarse, fine), rest = rmsDifference(fine, exact);
  INFO("change by twice the sampling " << change << ", left to the reference " << rest << ", largest opacity "
                                       << largestAlpha(exact));
  CHECK(largestAlpha(exact) > 0.05);  // there is something to compare
  CHECK(change < mostChange);
  CHECK(rest < 0.6 * change + floor);
  return rest;
}

}  // namespace umbrick
