// Light that is found by rays from each sample: against closed forms, the reference and light volumes.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "support/closed_forms.h"
#include "support/cone_scene.h"
#include "sweep/picture_of_grid.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/scene/lights.h"

using namespace umbrick;
using Catch::Contains;

TEST_CASE("A slab lit by cone rays is that of the closed form", "[sweep][cpu]") {
  const LitSlab slab(0.25);
  const Image colour = byRays(slab.grid, slab.scene).colour;
  // Segments of a quarter of a voxel, each with the light of one place: their square by sigma_t^2 / 12.
  CHECK(colour.at(1, 1)[0] == Approx(0.8 * slab.perAlbedo).epsilon(1e-4));
  CHECK(colour.at(1, 1)[2] == Approx(0.25 * slab.perAlbedo).epsilon(1e-4));
  CHECK(colour.at(0, 1)[3] == Approx(LitSlab::opacity()).epsilon(1e-5));
}

TEST_CASE("Cone rays give the picture of the reference, nearer than a light volume", "[sweep][cpu]") {
  const ScalarGrid grid = blobGrid();
  for (const Camera& camera : smallCameras(16)) {
    ResolvedScene scene = coneRayScene(tintedRamp(1), camera, 0.25, 8);
    INFO("perspective " << (camera.projection == Projection::perspective));
    const Image exact = sameLightsReference(grid, scene, 2e-4);
    CHECK(largestAlpha(exact) > 0.5);
    const double rays = rmsDifference(byRays(grid, scene).colour, exact);
    scene.method = Method::lightVolume;
    // What is left are segments, over which the value counts as linear; a light volume interpolates light, too.
    CHECK(rays < 1e-3);
    CHECK(rays < 0.5 * rmsDifference(byRays(grid, scene).colour, exact));
  }
}

TEST_CASE("Cone rays know lights of the world, light from behind, clipping and crooked volumes", "[sweep][cpu]") {
  const ScalarGrid grid = withTransform(blobGrid(), crookedTransform());
  Camera base;
  base.width = base.height = 12;
  ResolvedScene scene = coneRayScene(tintedRamp(1), orbitCamera(grid.worldBounds(), 1.7, 0.4, base), 0.25, 6);
  scene.transfer = tintedRamp(1 / shortestVoxelEdge(grid.indexToWorld()));
  scene.sampling.spacing = 0.25 * shortestVoxelEdge(grid.indexToWorld());
  SECTION("two lights") {
    scene.model = Model::lights;
    scene.lights = {{LightFrame::world, ConeLight{glm::dvec3(1, 1, 1), 0.5, glm::dvec3(1, 0.6, 0.2)}},
                    {LightFrame::view, ConeLight{glm::dvec3(0.3, 0.2, -1), 0.4, glm::dvec3(0.1, 0.3, 1)}}};
  }
  SECTION("the whole sphere") { scene.model = Model::ambient; }
  SECTION("a cut") { scene.clipPlanes = {{0, 0, 1, -grid.worldBounds().centre().z}}; }
  const Image exact = sameLightsReference(grid, scene, 2e-4);
  CHECK(largestAlpha(exact) > 0.3);
  CHECK(rmsDifference(byRays(grid, scene).colour, exact) < 2e-3);
}

TEST_CASE("Bricks and culling change nothing of cone rays", "[sweep][cpu]") {
  const ScalarGrid grid = makeSparse(glm::ivec3(-5, 7, 2), 3, 12, 90);
  const glm::dvec3 centre = grid.worldBounds().centre();
  ResolvedScene scene =
      coneRayScene(tintedRamp(0.5), perspectiveCamera(centre + glm::dvec3(70, 90, 120), centre, 0.7, 12), 0.25, 4);
  scene.sampling.spacing = 1;
  const Image cut = byRays(grid, scene).colour;
  CHECK(largestAlpha(cut) > 0.1);
  scene.bricks.culling = false;
  // Segments lie elsewhere where groups of cells are not skipped.
  CHECK(rmsDifference(byRays(grid, scene).colour, cut) < 1e-3);
  scene.bricks.culling = true;
  scene.bricks.bricked = false;
  CHECK(rmsDifference(byRays(grid, scene).colour, cut) < 1e-3);
}

TEST_CASE("What cone rays cannot draw is refused in one line", "[sweep][cpu]") {
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = coneRayScene(tintedRamp(1), smallCameras(8).front(), 0.25, 4);
  const auto bricks = cutGrid(grid, BrickOptions{.interior = 16, .apron = 2}, true);
  CHECK_THROWS_WITH(ShearWarpRenderer(*bricks, scene), "method: cone-rays is of media by rays, not of shear-warp");
  CHECK(!shearWarpSupports(scene));
  CHECK(raysSupport(scene));
  ResolvedScene shaded = scene;
  shaded.shading.kind = Shading::phong;
  CHECK_THROWS_WITH(RayRenderer(*bricks, shaded),
                    "shading.kind: phong takes light from a light volume, not from cone-rays");
  ResolvedScene surface = scene;
  surface.mode = Mode::isosurface;
  surface.surfaces = {SceneSurface{.value = 0.5}};
  CHECK_THROWS_WITH(RayRenderer(*cutGrid(grid, BrickOptions{.interior = 16, .apron = 5}, true), surface),
                    Contains("method: cone-rays is of media by rays, not of surfaces"));
  scene.transfer = withGradientOpacity(scene.transfer, {0.1, 0.2});
  CHECK_THROWS_WITH(
      RayRenderer(*cutGrid(grid, BrickOptions{.interior = 16, .apron = 1, .gradients = true}, true), scene),
      Contains("method: cone-rays on the CPU takes transfer functions of the value alone"));
}
