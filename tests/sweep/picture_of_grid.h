// Pictures of grids by techniques on the CPU.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>

#include "shade/hard_case.h"
#include "umbrick/brick/brick_grid.h"
#include "umbrick/sweep/ray_renderer.h"
#include "umbrick/sweep/shear_warp_renderer.h"
#include "umbrick/sweep/swept_bricks.h"

namespace umbrick {

inline std::unique_ptr<Bricks> cpuBricksFor(const ScalarGrid& grid, const ResolvedScene& scene) {
  return cutGrid(grid, sweptBricks(scene), scene.bricks.bricked);
}

inline Picture shearWarped(const ScalarGrid& grid, const ResolvedScene& scene, const RenderOptions& options = {},
                           std::optional<ShearWarpSampling> sampling = {}) {
  const auto bricks = cpuBricksFor(grid, scene);
  return ShearWarpRenderer(*bricks, scene, options, sampling).render();
}

inline Picture byRays(const ScalarGrid& grid, const ResolvedScene& scene, const RenderOptions& options = {},
                      std::optional<int> perVoxel = {}) {
  const auto bricks = cpuBricksFor(grid, scene);
  return RayRenderer(*bricks, scene, options, perVoxel).render();
}

/// What tests of both techniques go through.
inline constexpr Technique kCpuTechniques[]{Technique::rays, Technique::shearWarp};

inline Picture renderedOnCpu(Technique technique, const ScalarGrid& grid, const ResolvedScene& scene,
                             const RenderOptions& options = {}) {
  return technique == Technique::rays ? byRays(grid, scene, options) : shearWarped(grid, scene, options);
}

/// Renders with so many slices (and rays) a voxel and with twice as many, and compares with the reference. The value
/// counts as linear between slices and a warped picture as cubic between rays, which are off by the square of the
/// distance where the field is smooth, and by its 1.5th power at kinks of trilinear fields: the remaining error is a
/// third of the change, or 0.55 of it, see checkAgainstReference of tests/shade/hard_case.h.
/// @param warpFloor  allowed to shear-warp in addition, where the picture has edges that the warp blurs
inline void checkOnCpu(const ScalarGrid& grid, const ResolvedScene& scene, double floor = 5e-5,
                       double mostChange = 8e-3, double warpFloor = 0, int perVoxel = 2) {
  const Image exact = renderReference(grid, scene).colour;
  CHECK(largestAlpha(exact) > 0.05);  // there is something to compare
  for (const Technique technique : kCpuTechniques) {
    const auto pictureOf = [&](int each) {
      return technique == Technique::rays
                 ? byRays(grid, scene, {}, each).colour
                 : shearWarped(grid, scene, {}, ShearWarpSampling{each, static_cast<double>(each)}).colour;
    };
    const Image coarse = pictureOf(perVoxel), fine = pictureOf(2 * perVoxel);
    const double change = rmsDifference(coarse, fine), rest = rmsDifference(fine, exact);
    INFO(techniqueName(technique) << ": change by twice the sampling " << change << ", left to the reference " << rest
                                  << ", largest opacity " << largestAlpha(exact));
    const double more = technique == Technique::shearWarp ? warpFloor : 0;
    CHECK(change < mostChange + more);
    CHECK(rest < 0.6 * change + floor + more);
  }
}

}  // namespace umbrick
