// Light that is found by rays from each sample: against closed forms, the reference and light volumes.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "support/closed_forms.h"
#include "sweep/picture_of_grid.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/scene/lights.h"

using namespace umbrick;
using Catch::Contains;

namespace {

ResolvedScene coneScene(const TransferFunction& transfer, const Camera& camera, int directions = 8) {
  ResolvedScene scene = plainScene(transfer, camera, 0.25);
  scene.model = Model::cone;
  scene.method = Method::coneRays;
  scene.occlusion.aperture = 60 * kDegree;
  scene.occlusion.ordinates.directions = directions;
  return scene;
}

TransferFunction rampTo(double sigma_t) {
  return TransferFunction({{0, {{0.9, 0.6, 0.3}, 0}}, {1, {{0.9, 0.6, 0.3}, sigma_t}}});
}

Image trueColour(const ScalarGrid& grid, const ResolvedScene& scene) {
  ReferenceOptions options;
  options.lights = lightDirections(scene, scene.occlusion.ordinates.directions);
  options.tolerance = 2e-4;
  return renderReference(grid, scene, options).colour;
}

}  // namespace

// A slab of constant sigma_t from z = 4 to 20 that is seen along z, whose light comes from the eye's side in directions
// of cosine c: a point at depth x is lit by exp(-sigma_t x / c), so that the slab sends
//   albedo sum_k w_k c / (1 + c) (1 - exp(-sigma_t L (1 + 1/c))).
TEST_CASE("A slab lit by cone rays is that of the closed form", "[sweep][cpu]") {
  const ScalarGrid grid = makeFilled(glm::ivec3(64, 64, 24), glm::ivec3(0), [](const glm::ivec3&) { return 1.0; });
  const double sigma_t = 0.1;
  Camera camera = orthographicCamera({32, 32, 80}, {32, 32, 12}, 2, 2);
  camera.up = {0, 1, 0};
  ResolvedScene scene = coneScene(homogeneous({0.8, 0.5, 0.25}, sigma_t), camera, 16);
  scene.occlusion.aperture = 40 * kDegree;
  scene.clipBox = Box{{1, 1, 4}, {62, 62, 20}};
  double expected = 0;
  for (const LightDirection& light : lightDirections(scene, 16)) {
    const double c = light.direction.z;
    expected += light.radiance.r * c / (1 + c) * -std::expm1(-sigma_t * 16 * (1 + 1 / c));
  }
  const Image colour = byRays(grid, scene).colour;
  // Segments of a quarter of a voxel, each with the light of one place: their square by sigma_t^2 / 12.
  CHECK(colour.at(1, 1)[0] == Approx(0.8 * expected).epsilon(1e-4));
  CHECK(colour.at(1, 1)[2] == Approx(0.25 * expected).epsilon(1e-4));
  CHECK(colour.at(0, 1)[3] == Approx(-std::expm1(-sigma_t * 16)).epsilon(1e-5));
}

TEST_CASE("Cone rays give the picture of the reference, nearer than a light volume", "[sweep][cpu]") {
  const ScalarGrid grid = blobGrid();
  for (const Camera& camera : smallCameras(16)) {
    ResolvedScene scene = coneScene(rampTo(1), camera);
    INFO("perspective " << (camera.projection == Projection::perspective));
    const Image exact = trueColour(grid, scene);
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
  ResolvedScene scene = coneScene(rampTo(1), orbitCamera(grid.worldBounds(), 1.7, 0.4, base), 6);
  scene.transfer = rampTo(1 / shortestVoxelEdge(grid.indexToWorld()));
  scene.sampling.spacing = 0.25 * shortestVoxelEdge(grid.indexToWorld());
  SECTION("two lights") {
    scene.model = Model::lights;
    scene.lights = {{LightFrame::world, ConeLight{glm::dvec3(1, 1, 1), 0.5, glm::dvec3(1, 0.6, 0.2)}},
                    {LightFrame::view, ConeLight{glm::dvec3(0.3, 0.2, -1), 0.4, glm::dvec3(0.1, 0.3, 1)}}};
  }
  SECTION("the whole sphere") { scene.model = Model::ambient; }
  SECTION("a cut") { scene.clipPlanes = {{0, 0, 1, -grid.worldBounds().centre().z}}; }
  const Image exact = trueColour(grid, scene);
  CHECK(largestAlpha(exact) > 0.3);
  CHECK(rmsDifference(byRays(grid, scene).colour, exact) < 2e-3);
}

TEST_CASE("Bricks and culling change nothing of cone rays", "[sweep][cpu]") {
  const ScalarGrid grid = makeSparse(glm::ivec3(-5, 7, 2), 3, 12, 90);
  const glm::dvec3 centre = grid.worldBounds().centre();
  ResolvedScene scene = coneScene(rampTo(0.5), perspectiveCamera(centre + glm::dvec3(70, 90, 120), centre, 0.7, 12), 4);
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
  ResolvedScene scene = coneScene(rampTo(1), smallCameras(8).front(), 4);
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
