// The mode hybrid by rays on OpenGL: against closed forms, rays on the CPU and the reference.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "support/gl_fixture.h"
#include "support/hybrid_scenes.h"
#include "support/observed_order.h"
#include "sweep/value_picture.h"
#include "umbrick/core/error.h"
#include "umbrick/shade/ray_caster.h"

using namespace umbrick;
using Catch::Contains;

namespace {

Picture castHybrid(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene, bool layers = false,
                   const AtlasLimits& limits = {}) {
  RenderOptions options;
  options.visibilityAndDepth = layers;
  BrickOptions cut;
  cut.interior = scene.bricks.interior;
  cut.apron = 3;  // light is taken two voxels in front of a surface
  cut.gradients = scene.transfer.is2d();
  const auto volume = cutGrid(grid, cut, scene.bricks.bricked);
  return RayCaster(context, *volume, scene, options, limits).render();
}

// Places along a ray are single precision, as in the test of surfaces: what begins there is off by this.
constexpr double kPlace = 1e-4;

}  // namespace

TEST_CASE("The medium behind the first surface is seen on OpenGL with what that lets through",
          "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = fallingGrid();
  for (const double opacity : {0.0, 0.35, 1.0}) {
    const double behind = 1 - std::exp(-kDense * 13), through = 1 - opacity;
    ResolvedScene scene = fallingScene(opacity);
    const Picture picture = castHybrid(*context, grid, scene, true);
    const float* const pixel = picture.colour.at(1, 2);
    CHECK(pixel[0] == Approx(opacity + through * behind * kBlue.r).margin(kPlace));
    CHECK(pixel[2] == Approx(through * behind * kBlue.b).margin(kPlace));
    CHECK(pixel[3] == Approx(opacity + through * behind).margin(kPlace));
    CHECK(layerOf(picture, "value").at(1, 2)[0] == Approx(0.3));
    CHECK(layerOf(picture, "position").at(1, 2)[2] == Approx(14).margin(kPlace));
    const double tau = kDense * 13, sum = (1 - (1 + tau) * std::exp(-tau)) / kDense;
    CHECK(*picture.depth.at(1, 2) ==
          Approx((opacity * 46 + through * (46 * behind + sum)) / (opacity + through * behind)).margin(5e-3));
    CHECK(*picture.visibility.at(1, 2) == Approx(opacity + through * behind).margin(kPlace));
    // Without layers the colour is the same, and there are no others.
    const Picture alone = castHybrid(*context, grid, scene);
    CHECK(maxDifference(alone.colour, picture.colour) == 0);
    CHECK(alone.layers.empty());
    CHECK(alone.depth.pixels.empty());
  }
}

TEST_CASE("A ray that meets no surface shows nothing on OpenGL", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  ResolvedScene scene = fallingScene(0.35);
  scene.clipBox = Box{{0, 0, 15}, {19, 19, 18}};  // before both surfaces
  CHECK(largestAlpha(castHybrid(*context, fallingGrid(), scene).colour) == 0);
}

TEST_CASE("Behind a clear surface around it a medium on OpenGL is the one of integrate", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  for (const Camera& camera : smallCameras())
    for (int light = 0; light < 3; ++light) {
      ResolvedScene scene = hybridScene(nothingBelow(0.3), camera, {surfaceAt(0.25, 0)});
      if (light == 1) {
        scene.model = Model::cone;
        scene.method = Method::lightVolume;
      }
      if (light == 2) scene.shading.kind = Shading::phong;
      const Picture hybrid = castHybrid(*context, grid, scene, true);
      scene.mode = Mode::integrate;
      const Picture whole = castHybrid(*context, grid, scene, true);
      CHECK(largestAlpha(whole.colour) > 0.5);
      // A segment that the surface cuts is integrated from there, where it is clear up to the medium: its value runs
      // linearly over less of the cell, so that it is nearer to the truth.
      CHECK(rmsDifference(hybrid.colour, whole.colour) < 2e-4);
      CHECK(rmsDifference(hybrid.visibility, whole.visibility) < 2e-4);
    }
}

TEST_CASE("Surfaces with a medium behind them are on OpenGL those of the reference and of the CPU",
          "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid blobs = withTransform(blobGrid(), crookedTransform());
  Camera base;
  base.width = base.height = 32;
  for (const Projection projection : {Projection::orthographic, Projection::perspective})
    for (const Shading shading : {Shading::automatic, Shading::phong, Shading::none}) {
      base.projection = projection;
      ResolvedScene scene = hybridScene(nothingBelow(0.05), orbitCamera(blobs.worldBounds(), 1.7, 0.4, base),
                                        {surfaceAt(0.5, 0.4), surfaceAt(0.2, 0.3)});
      scene.sampling.spacing = 0.1 * shortestVoxelEdge(blobs.indexToWorld());
      scene.shading.kind = shading;
      INFO("perspective " << (projection == Projection::perspective) << ", shading " << static_cast<int>(shading));
      const Picture seen = castHybrid(*context, blobs, scene, true);
      CHECK(rmsDifference(seen.colour, renderReference(blobs, scene).colour) < 2e-3);
      CHECK(rmsDifference(seen.colour, valuePicture(blobs, scene, 8).colour) < 2e-3);
    }
  const ScalarGrid colon = colonGrid();
  for (const double fov : {60.0, 150.0}) {
    ResolvedScene scene = hybridScene(colonTransfer(), colonCamera(fov * kDegree, 40), {surfaceAt(0.5, 0.6)});
    scene.sampling.spacing = 0.1;  // of depths, which are up to 5.4 times as far apart along a ray at 150 degrees
    CAPTURE(fov);
    CHECK(rmsDifference(castHybrid(*context, colon, scene).colour, renderReference(colon, scene).colour) < 2e-3);
  }
}

TEST_CASE("Bricks that are skipped, cut and drawn in runs change no hybrid on OpenGL", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeSparse(glm::ivec3(-5, 7, 2), 3, 12, 90);
  const glm::dvec3 centre = grid.worldBounds().centre();
  ResolvedScene scene =
      hybridScene(nothingBelow(0.1), perspectiveCamera(centre + glm::dvec3(70, 90, 120), centre, 0.7, 60),
                  {surfaceAt(0.5, 0.5), surfaceAt(0.3, 0.2)});
  const Picture first = castHybrid(*context, grid, scene, true);
  CHECK(largestAlpha(first.colour) > 0.5);
  AtlasLimits small;
  small.budgetBytes = first.stats.textureBytes / 5;
  const Picture inRuns = castHybrid(*context, grid, scene, true, small);
  CHECK(inRuns.stats.textureBytes < first.stats.textureBytes / 2);
  // A ray along a rim may meet it in one and not in the other.
  CHECK(rmsDifference(inRuns.colour, first.colour) < 1e-3);
  scene.bricks.culling = false;
  CHECK(rmsDifference(castHybrid(*context, grid, scene).colour, first.colour) < 1e-3);
  scene.bricks.bricked = false;
  CHECK(rmsDifference(castHybrid(*context, grid, scene).colour, first.colour) < 1e-3);
}

TEST_CASE("A renderer on OpenGL comes to hybrid and leaves it", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  const ResolvedScene hybrid = hybridScene(nothingBelow(0.1), smallCameras()[1], {surfaceAt(0.3, 0.5)});
  ResolvedScene surface = hybrid, medium = hybrid, small = hybrid;
  surface.mode = Mode::isosurface;
  medium.mode = Mode::integrate;
  small.camera.width = small.camera.height = 20;
  const auto bricks = cutGrid(grid, BrickOptions{.interior = 16, .apron = 2}, true);
  RayCaster caster(*context, *bricks, hybrid);
  for (const ResolvedScene& scene : {hybrid, surface, hybrid, medium, small, hybrid}) {
    caster.setScene(scene);
    CHECK(maxDifference(caster.render().colour, RayCaster(*context, *bricks, scene).render().colour) == 0);
  }
  ResolvedScene none = hybrid;
  none.surfaces.clear();
  CHECK_THROWS_WITH(caster.setScene(none), Contains("must be one value or more for the mode hybrid"));
}
