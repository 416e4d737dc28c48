// Gradients by B-splines in pictures of OpenGL: against the CPU, the reference and bricks that are cut otherwise.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "shade/cast_grid.h"
#include "shade/grid_picture.h"
#include "support/gl_fixture.h"
#include "support/observed_order.h"
#include "support/small_blobs.h"
#include "sweep/value_picture.h"
#include "umbrick/core/error.h"
#include "umbrick/image/image_difference.h"

using namespace umbrick;
using Catch::Contains;

namespace {

ResolvedScene splinedScene(const ScalarGrid& grid, Projection projection) {
  Camera base;
  base.width = base.height = 24;
  base.projection = projection;
  ResolvedScene scene =
      plainScene(TransferFunction({{0.05, {{0.9, 0.6, 0.3}, 0}}, {1, {{0.4, 0.7, 0.9}, 0.8}}}),
                 orbitCamera(grid.worldBounds(), 1.7, 0.4, base), 0.25 * shortestVoxelEdge(grid.indexToWorld()));
  scene.gradients = GradientFilter::bspline;
  return scene;
}

ResolvedScene centralOf(ResolvedScene scene) {
  scene.gradients = GradientFilter::central;
  return scene;
}

}  // namespace

TEST_CASE("Gradients by B-splines are on OpenGL those of the CPU and of the reference", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = withTransform(makeFilled(glm::ivec3(24), glm::ivec3(0), smallBlobs), crookedTransform());
  const ResolvedScene plain = splinedScene(grid, Projection::perspective);
  ResolvedScene surface = plain, shaded = plain, ramp = plain;
  surface.mode = Mode::isosurface;
  surface.surfaces = {surfaceAt(0.5, 0.6), surfaceAt(0.2, 0.4)};
  shaded.shading = {Shading::phong, ShadingLight::automatic, 0.15, 0.7, 0.4, 8};
  ramp.gradientOpacity = {0.03, 0.13};
  ramp.transfer = withGradientOpacity(ramp.transfer, ramp.gradientOpacity);

  const Picture seen = castGrid(*context, grid, surface, true);
  const Picture onCpu = valuePicture(grid, surface, {}, true);
  // A pixel at a silhouette may show the surface in one and not in the other: 24 x 24 pixels, of which a few.
  CHECK(rmsDifference(seen.colour, onCpu.colour) < 1e-3);
  CHECK(differenceOf(layerOf(seen, "normal"), layerOf(onCpu, "normal")).p999 < 2e-3);
  CHECK(rmsDifference(seen.colour, castGrid(*context, grid, centralOf(surface)).colour) > 5e-4);

  for (const ResolvedScene& medium : {shaded, ramp}) {
    INFO("2D " << medium.transfer.is2d());
    const Image exact = renderReference(grid, medium).colour;
    const Picture ours = castGrid(*context, grid, medium);
    CHECK(largestAlpha(exact) > 0.3);
    const double off = rmsDifference(ours.colour, exact);
    CHECK(off < 1e-3);
    CHECK(rmsDifference(ours.colour, valuePicture(grid, medium, 4).colour) < 1e-3);
    CHECK(off < rmsDifference(castGrid(*context, grid, centralOf(medium)).colour, exact));
    AtlasLimits small;
    small.budgetBytes = ours.stats.textureBytes / 3;
    CHECK(maxDifference(castGrid(*context, grid, medium, false, small).colour, ours.colour) < 1e-4);
  }
  CHECK(rmsDifference(renderGrid(*context, grid, ramp).colour, renderReference(grid, ramp).colour) < 1e-3);
}

TEST_CASE("Bricks of the other kind of gradients are refused on OpenGL", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled(glm::ivec3(24), glm::ivec3(0), smallBlobs);
  ResolvedScene scene = splinedScene(grid, Projection::perspective);
  scene.transfer = withGradientOpacity(scene.transfer, {0.03, 0.13});
  const auto others = valueBricks(grid, centralOf(scene));
  CHECK_THROWS_WITH(RayCaster(*context, *others, scene),
                    Contains("gradients: is bspline, bricks have those of the kind central"));
}
