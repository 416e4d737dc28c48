// Media that reflect light, by rays on OpenGL: against a closed form, rays on the CPU and the reference.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "support/gl_fixture.h"
#include "support/observed_order.h"
#include "support/small_blobs.h"
#include "sweep/value_picture.h"
#include "umbrick/scene/shading_lights.h"
#include "umbrick/shade/ray_caster.h"

using namespace umbrick;
using Catch::Contains;

namespace {

ResolvedScene shadedScene(const TransferFunction& transfer, const Camera& camera) {
  ResolvedScene scene = plainScene(transfer, camera, 0.5);
  scene.shading = {Shading::phong, ShadingLight::automatic, 0.15, 0.7, 0.4, 8};
  return scene;
}

void addLights(ResolvedScene& scene) {
  scene.shading.light = ShadingLight::sources;
  scene.lights = {{LightFrame::world, ConeLight{{1, 2, 3}, 0, {1, 0.7, 0.2}}},
                  {LightFrame::view, ConeLight{{-1, 0.5, 1}, 0, {0, 0.2, 0.5}}}};
}

TransferFunction coloured() { return TransferFunction({{0.05, {{0.9, 0.6, 0.3}, 0}}, {1, {{0.4, 0.7, 0.9}, 0.8}}}); }

Picture castShaded(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene,
                   const AtlasLimits& limits = {}) {
  const auto volume = valueBricks(grid, scene);
  return RayCaster(context, *volume, scene, {}, limits).render();
}

}  // namespace

// Where the value is linear all central differences are its slope, and a constant medium of optical depth tau sends
// (1 - exp(-tau)) times what is reflected.
TEST_CASE("A medium of one slope reflects on OpenGL what Phong's model says", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const glm::dvec3 slope(0.02, 0.01, 0.04), albedo(0.8, 0.5, 0.25);
  const ScalarGrid grid =
      makeFilled(glm::ivec3(32), glm::ivec3(0), [&](const glm::ivec3& i) { return glm::dot(slope, glm::dvec3(i)); });
  ResolvedScene scene =
      shadedScene(TransferFunction({{0, {albedo, 0.1}}}), orthographicCamera({40, 30, 80}, glm::dvec3(15.5), 6, 8));
  scene.clipBox = Box{glm::dvec3(8), glm::dvec3(24)};
  for (const bool sources : {false, true}) {
    if (sources) addLights(scene);
    const Image colour = castShaded(*context, grid, scene).colour;
    const CameraFrame frame = cameraFrame(scene.camera);
    const glm::dvec3 viewer = -frame.forward;
    glm::dvec3 normal = glm::normalize(slope), reflected(0.15);
    if (glm::dot(normal, viewer) < 0) normal = -normal;
    for (const ShadingLightRay& light :
         sources ? shadingLights(scene) : std::vector<ShadingLightRay>{{viewer, glm::dvec3(1)}}) {
      const double facing = std::max(0.0, glm::dot(normal, light.towards));
      const double mirrored = glm::dot(2 * facing * normal - light.towards, viewer);
      reflected += light.radiance * (0.7 * facing + (facing > 0 && mirrored > 0 ? 0.4 * std::pow(mirrored, 8) : 0));
    }
    double worst = 0;
    for (std::size_t i = 0; i < colour.pixels.size(); i += 4)
      for (int c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(colour.pixels[i + static_cast<std::size_t>(c)] -
                                         colour.pixels[i + 3] * albedo[c] * reflected[c]));
    CHECK(colour.pixels[3] > 0.5);
    // Differences of floats of up to 2, of 0.02 and more, turn normals by 1e-5.
    CHECK(worst < 1e-4);
  }
}

TEST_CASE("A medium that reflects light on OpenGL is that of the reference and of the CPU",
          "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = withTransform(makeFilled(glm::ivec3(24), glm::ivec3(0), smallBlobs), crookedTransform());
  Camera base;
  base.width = base.height = 32;
  for (const Projection projection : {Projection::orthographic, Projection::perspective})
    for (const bool sources : {false, true}) {
      base.projection = projection;
      ResolvedScene scene = shadedScene(coloured(), orbitCamera(grid.worldBounds(), 1.7, 0.4, base));
      if (sources) addLights(scene);
      scene.sampling.spacing = 0.25 * shortestVoxelEdge(grid.indexToWorld());
      INFO("perspective " << (projection == Projection::perspective) << ", sources " << sources);
      const Image exact = renderReference(grid, scene).colour;
      CHECK(largestAlpha(exact) > 0.5);
      const Picture ours = castShaded(*context, grid, scene);
      // Light counts as that of a segment's middle.
      CHECK(rmsDifference(ours.colour, exact) < 1e-3);
      CHECK(rmsDifference(ours.colour, valuePicture(grid, scene, 4).colour) < 1e-3);
      AtlasLimits small;
      small.budgetBytes = ours.stats.textureBytes / 3;
      CHECK(maxDifference(castShaded(*context, grid, scene, small).colour, ours.colour) < 1e-4);
      ResolvedScene unshaded = scene;
      unshaded.shading = {};
      CHECK(rmsDifference(castShaded(*context, grid, unshaded).colour, exact) > 1e-2);
    }
}

TEST_CASE("Shading comes and goes with a scene on OpenGL, and what cannot reflect is refused",
          "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled(glm::ivec3(24), glm::ivec3(0), smallBlobs);
  ResolvedScene shaded = shadedScene(coloured(), smallCameras().front());
  const auto bricks = valueBricks(grid, shaded);
  ResolvedScene plain = shaded, lit = shaded;
  lit.model = Model::cone;
  lit.method = Method::lightVolume;
  const ResolvedScene both = lit;
  plain.shading = lit.shading = {};
  RayCaster renderer(*context, *bricks, lit);
  for (const ResolvedScene& scene : {lit, shaded, lit, both, lit, plain, both, shaded}) {
    renderer.setScene(scene);
    CHECK(maxDifference(renderer.render().colour, RayCaster(*context, *bricks, scene).render().colour) == 0);
  }
  const auto thin = cutGrid(grid, BrickOptions{.interior = 16, .apron = 1}, true);
  CHECK_THROWS_WITH(RayCaster(*context, *thin, shaded), Contains("shading needs an apron of 2 voxels, found 1"));
  shaded.shading.light = ShadingLight::sources;
  CHECK_THROWS_WITH(renderer.setScene(shaded), Contains("shading.light: the scene has no directional source"));
}
