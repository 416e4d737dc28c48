// Compares pictures of a grid with those of the reference, for hard cases.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "shade/grid_picture.h"
#include "support/observed_order.h"
#include "umbrick/reference/reference.h"

namespace umbrick {

inline bool allWithin(const Image& image, float low, float high) {
  return std::all_of(image.pixels.begin(), image.pixels.end(), [&](float v) { return v >= low && v <= high; });
}

/// Renders at the scene's spacing and at half of it and compares with the reference. Both pictures are of one method,
/// so that the error at half the spacing follows from how much the halving changed.
///   emission     A value that counts as linear over a slab is wrong by the square of the spacing in a voxel cell, and
///                more often at kinks of the trilinear field: the remaining error is a third of the change, or
///                1 / (2^1.5 - 1) = 0.55 of it.
///   cone         V is that of a slab's front, which is of first order: the remaining error is as large as the change,
///                and the two pictures extrapolate to a better one. This needs theta = 0 and a parallel view, where dos
///                is the model itself.
/// Rounding, the table of the transfer function and the reference's tolerance are allowed for by `floor`.
/// @return the change
inline double checkAgainstReference(const GlContext& context, const ScalarGrid& grid, ResolvedScene scene,
                                    double floor = 2e-5, double mostChange = 5e-3) {
  const Image exact = renderReference(grid, scene).colour;
  const Image coarse = renderGrid(context, grid, scene).colour;
  scene.sampling.spacing *= 0.5;
  const Image fine = renderGrid(context, grid, scene).colour;
  const double change = rmsDifference(coarse, fine), rest = rmsDifference(fine, exact);
  INFO("change by halving the spacing " << change << ", left to the reference " << rest << ", largest opacity "
                                        << largestAlpha(exact));
  CHECK(largestAlpha(exact) > 0.05);  // there is something to compare
  if (scene.model == Model::emission) {
    CHECK(change < mostChange);
    CHECK(rest < 0.6 * change + floor);
    return change;
  }
  Image extrapolated = fine;
  for (std::size_t i = 0; i < fine.pixels.size(); ++i) extrapolated.pixels[i] = 2 * fine.pixels[i] - coarse.pixels[i];
  const double beyond = rmsDifference(extrapolated, exact);
  INFO("extrapolated " << beyond);
  CHECK(change < 10 * mostChange);
  CHECK(rest < 1.2 * change + floor);
  CHECK(beyond < 0.35 * change + floor + 1e-4);  // 1e-4: the tolerance of the reference
  return change;
}

/// Compares both models that have an exact counterpart, from a parallel and a perspective view that see `bounds`.
inline void checkViewsAgainstReference(const GlContext& context, const ScalarGrid& grid,
                                       const TransferFunction& transfer, const Box& bounds, double spacing,
                                       int size = 32) {
  Camera base;
  base.width = base.height = size;
  for (const Projection projection : {Projection::orthographic, Projection::perspective})
    for (const Model model : {Model::emission, Model::cone}) {
      if (model == Model::cone && projection == Projection::perspective) continue;
      INFO("perspective " << (projection == Projection::perspective) << ", cone " << (model == Model::cone));
      base.projection = projection;
      ResolvedScene scene = plainScene(transfer, orbitCamera(bounds, 0.6, 0.4, base), spacing);
      scene.model = model;
      scene.occlusion.aperture = 0;
      checkAgainstReference(context, grid, scene);
    }
}

}  // namespace umbrick
