// Light that rays on OpenGL look for from each sample: against rays on the CPU, closed forms and the reference.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "support/closed_forms.h"
#include "support/cone_scene.h"
#include "sweep/picture_of_grid.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/lights.h"
#include "umbrick/shade/ray_caster.h"

using namespace umbrick;
using Catch::Contains;

namespace {

Picture litOnGl(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene, bool layers = false,
                const AtlasLimits& limits = {}) {
  RenderOptions options;
  options.visibilityAndDepth = layers;
  const auto bricks = bricksFor(grid, scene);
  return RayCaster(context, *bricks, scene, options, limits).render();
}

}  // namespace

TEST_CASE("A slab lit by cone rays on OpenGL is that of the closed form", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const LitSlab slab(0.5);
  const Picture picture = litOnGl(*context, slab.grid, slab.scene);
  // Segments of half a voxel, each with the light of one place, are off by (sigma_t / 2)^2 / 12 = 2e-4 of it or less.
  CHECK(picture.colour.at(1, 1)[0] == Approx(0.8 * slab.perAlbedo).epsilon(2e-4));
  CHECK(picture.colour.at(1, 1)[2] == Approx(0.25 * slab.perAlbedo).epsilon(2e-4));
  CHECK(picture.colour.at(0, 1)[3] == Approx(LitSlab::opacity()).epsilon(1e-5));
  CHECK(picture.stats.directions == LitSlab::kDirections);
}

// Segments lie at other places: slabs of depth here, parts of groups of cells there. Over each the value counts as
// linear, which moves pictures of the CPU with segments of 1/4 voxel and of 1/2 voxel by up to 1e-3, too.
TEST_CASE("Cone rays on OpenGL give the picture of those on the CPU", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = withTransform(blobGrid(), crookedTransform());
  const double edge = shortestVoxelEdge(grid.indexToWorld());
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    Camera base;
    base.width = base.height = 16;
    base.projection = projection;
    ResolvedScene scene = coneRayScene(tintedRamp(1 / edge), orbitCamera(grid.worldBounds(), 1.7, 0.4, base), 0.5, 5);
    scene.sampling.spacing = 0.5 * edge;
    SECTION("cone") {}
    SECTION("lights") {
      scene.model = Model::lights;
      scene.lights = {{LightFrame::world, ConeLight{glm::dvec3(1, 1, 1), 0.5, glm::dvec3(1, 0.6, 0.2)}},
                      {LightFrame::view, ConeLight{glm::dvec3(0.3, 0.2, -1), 0.4, glm::dvec3(0.1, 0.3, 1)}}};
    }
    SECTION("the whole sphere") { scene.model = Model::ambient; }
    SECTION("a cut") { scene.clipPlanes = {{0, 0, 1, -grid.worldBounds().centre().z}}; }
    SECTION("from within") { scene.camera.eye = scene.camera.lookAt + 4.0 * edge * glm::dvec3(0.5, 0.6, 0.4); }
    INFO("perspective " << (projection == Projection::perspective));
    RenderOptions layers;
    layers.visibilityAndDepth = true;
    const Picture expected = byRays(grid, scene, layers), picture = litOnGl(*context, grid, scene, true);
    CHECK(largestAlpha(expected.colour) > 0.3);
    CHECK(rmsDifference(picture.colour, expected.colour) < 1e-3);
    CHECK(rmsDifference(picture.visibility, expected.visibility) < 1e-3);
  }
}

// The function is of value and gradient; where it does not look at the gradient, it is that of the value.
TEST_CASE("Cone rays on OpenGL take functions of value and gradient", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene =
      coneRayScene(withGradientOpacity(tintedRamp(1.5), {0.02, 0.1}), smallCameras(12).front(), 0.5, 4);
  const Image exact = sameLightsReference(grid, scene, 5e-4);
  CHECK(largestAlpha(exact) > 0.2);
  // Value and gradient count as linear over half a voxel of a view ray, and over one of a ray towards the light.
  CHECK(rmsDifference(litOnGl(*context, grid, scene).colour, exact) < 2e-3);
}

TEST_CASE("Bricks and culling change nothing of cone rays on OpenGL", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeSparse(glm::ivec3(-5, 7, 2), 3, 12, 90);
  const glm::dvec3 centre = grid.worldBounds().centre();
  ResolvedScene scene =
      coneRayScene(tintedRamp(0.5), perspectiveCamera(centre + glm::dvec3(70, 90, 120), centre, 0.7, 16), 0.5, 4);
  const Picture cut = litOnGl(*context, grid, scene);
  CHECK(largestAlpha(cut.colour) > 0.1);
  // The same segments, of view rays and of those towards the light; see kSameSegments of the tests of rays.
  scene.bricks.culling = false;
  CHECK(maxDifference(litOnGl(*context, grid, scene).colour, cut.colour) < 6e-4);
  scene.bricks.culling = true;
  const Picture spread = litOnGl(*context, grid, scene, false, {.maxTextureEdge = 64});
  CHECK(spread.stats.textures > 1);
  CHECK(maxDifference(spread.colour, cut.colour) < 6e-4);
}

TEST_CASE("What cone rays on OpenGL cannot draw is refused in one line", "[shade][rays][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = coneRayScene(tintedRamp(1), smallCameras(8).front(), 0.5, 4);
  scene.bricks.interior = 8;
  const auto bricks = bricksFor(grid, scene);
  const Picture all = litOnGl(*context, grid, scene);
  const std::uint64_t slot = all.stats.textureBytes / all.stats.brickSlots;
  RayCaster few(*context, *bricks, scene, {}, {.budgetBytes = 3 * slot});
  CHECK_THROWS_WITH(few.draw(),
                    "bricks.budgetMiB: cone-rays need all visible bricks at once, which are more than fit the memory "
                    "budget or OpenGL");
  // Of 64 voxels times 600 directions it would not do all turns of the shader's loops.
  if (context->software()) {
    const ScalarGrid wide = makeFilled(glm::ivec3(64, 8, 8), glm::ivec3(0), [](const glm::ivec3&) { return 1.0; });
    ResolvedScene many = coneRayScene(tintedRamp(1), perspectiveCamera({30, 4, 60}, {30, 4, 4}, 0.7, 4), 0.5, 600);
    CHECK_THROWS_WITH(litOnGl(*context, wide, many),
                      "occlusion.directions: 600 cone-rays of a segment are more than "
                      "software OpenGL takes through this volume");
  }
  ResolvedScene shaded = scene;
  shaded.shading.kind = Shading::phong;
  CHECK_THROWS_WITH(RayCaster(*context, *bricks, shaded),
                    "shading.kind: phong takes light from a light volume, not from cone-rays");
  ResolvedScene sliced = scene;
  sliced.technique = Technique::slices;
  CHECK_THROWS_WITH(SliceRenderer(*context, *bricks, sliced),
                    Contains("method: cone-rays is of media by rays, not of slices"));
}
