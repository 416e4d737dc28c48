// Pictures made on the CPU with light from light volumes.
// SPDX-License-Identifier: Apache-2.0
#include "sweep/picture_of_grid.h"
#include "umbrick/scene/lights.h"

using namespace umbrick;

namespace {

ResolvedScene litScene(const TransferFunction& transfer, const Camera& camera) {
  ResolvedScene scene = plainScene(transfer, camera, 0.5);
  scene.model = Model::cone;
  scene.method = Method::lightVolume;
  scene.occlusion.aperture = 60 * kDegree;
  scene.occlusion.ordinates.directions = 12;
  return scene;
}

Image exactColour(const ScalarGrid& grid, const ResolvedScene& scene) {
  ReferenceOptions options;
  options.lights = lightDirections(scene, scene.occlusion.ordinates.directions);
  options.tolerance = 2e-4;
  return renderReference(grid, scene, options).colour;
}

}  // namespace

// What is left is the interpolation of light between voxels, as for slices (tests/shade/light_volume_gl_test.cpp).
TEST_CASE("On the CPU, too, a light volume gives the picture of the reference", "[sweep][cpu][light-volume]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid = blobGrid();
  for (const auto& [sigma_t, most] : {std::pair{0.3, 2e-3}, {1.0, 6e-3}})
    for (const Camera& camera : smallCameras(40)) {
      const ResolvedScene scene = litScene(ramp(sigma_t), camera);
      INFO("sigma_t " << sigma_t << ", perspective " << (camera.projection == Projection::perspective));
      CHECK(rmsDifference(renderedOnCpu(technique, grid, scene).colour, exactColour(grid, scene)) < most);
    }
}

TEST_CASE("Coloured lights of the world give the picture of the reference", "[sweep][cpu][light-volume]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = litScene(ramp(0.7), smallCameras(40)[1]);
  scene.model = Model::lights;
  scene.lights = {{LightFrame::world, ConeLight{glm::dvec3(1, 1, 1), 0.5, glm::dvec3(1, 0.6, 0.2)}},
                  {LightFrame::world, ConeLight{glm::dvec3(0.4, -0.1, 1), 0.3, glm::dvec3(0.1, 0.3, 1)}}};
  CHECK(rmsDifference(renderedOnCpu(technique, grid, scene).colour, exactColour(grid, scene)) < 6e-3);
}

TEST_CASE("Light of the whole sphere and from behind gives the picture of the reference",
          "[sweep][cpu][light-volume][slow]") {
  const ScalarGrid grid = blobGrid();
  for (const Camera& camera : smallCameras(14)) {
    ResolvedScene scene = litScene(ramp(0.7), camera);
    scene.model = Model::ambient;
    scene.occlusion.ordinates.directions = 24;
    const Image exact = exactColour(grid, scene);
    // All of the sphere, not these directions alone.
    ReferenceOptions sphere;
    sphere.directions = 64;
    sphere.tolerance = 1e-3;
    const Image whole = renderReference(grid, scene, sphere).colour;
    ResolvedScene behind = scene;
    behind.model = Model::lights;
    behind.lights = {{LightFrame::view, ConeLight{glm::dvec3(0.3, 0.2, -1), 0.4, glm::dvec3(1, 0.7, 0.4)}},
                     {LightFrame::view, ConeLight{glm::dvec3(1, 0, 0), 0.2, glm::dvec3(0.2, 0.3, 0.6)}}};
    const Image exactBehind = exactColour(grid, behind);
    for (const Technique technique : kCpuTechniques) {
      INFO(techniqueName(technique) << ", perspective " << (camera.projection == Projection::perspective));
      const Image picture = renderedOnCpu(technique, grid, scene).colour;
      CHECK(rmsDifference(picture, exact) < 6e-3);
      // 24 directions are a quarter of a radian from their neighbours.
      CHECK(rmsDifference(picture, whole) < 8e-3);
      CHECK(rmsDifference(renderedOnCpu(technique, grid, behind).colour, exactBehind) < 6e-3);
    }
  }
}

// A point in the middle of a ball of constant extinction is lit through its radius from all sides.
TEST_CASE("The middle of a ball is lit through its radius", "[sweep][cpu][light-volume]") {
  const ScalarGrid grid = makeFilled(glm::ivec3(33), {0, 0, 0}, [](const glm::ivec3& i) {
    return std::clamp(10.5 - glm::length(glm::dvec3(i) - glm::dvec3(16)), 0.0, 1.0);
  });
  ResolvedScene scene = litScene(ramp(0.15), orthographicCamera({16, 16, 60}, {16, 16, 16}, 2, 8));
  scene.model = Model::ambient;
  scene.occlusion.ordinates.directions = 64;
  // A sheet in the middle is all that is left of the ball, but for the light that reaches it.
  const Image whole = byRays(grid, scene).colour;
  scene.clipPlanes = {{0, 0, 1, -15.9}, {0, 0, -1, 16.1}};
  const Image sheet = byRays(grid, scene).colour;
  // Of the sheet alone, light comes from everywhere: V is 1 but for the sheet itself, whose depth is 0.03.
  const double depth = 0.2 * 0.15, alpha = -std::expm1(-depth);
  CHECK(sheet.at(4, 4)[3] == Approx(alpha).epsilon(1e-3));
  CHECK(sheet.at(4, 4)[0] > 0.85 * kAlbedo.r * alpha);
  CHECK(whole.at(4, 4)[3] == Approx(-std::expm1(-0.15 * 20)).epsilon(2e-2));
  // The mean over the way of what is scattered to the eye lies between what the rim and the middle get: V of the middle
  // is exp(-1.5), V of the rim about a half and more.
  const double seen = whole.at(4, 4)[0] / (kAlbedo.r * whole.at(4, 4)[3]);
  CHECK(seen > std::exp(-1.5));
  CHECK(seen < 0.75);
}

TEST_CASE("Light of a cut begins at the cut", "[sweep][cpu][light-volume]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid = makeFilled(glm::ivec3(24), {0, 0, 0}, [](const glm::ivec3&) { return 1.0; });
  for (const Camera& camera : smallCameras(40))
    for (const double offset : {0.0, 0.37, 0.71}) {
      ResolvedScene scene = litScene(ramp(0.5), camera);
      const glm::dvec3 inside = glm::normalize(glm::dvec3(-0.5, -0.2, -0.9));
      scene.clipPlanes.emplace_back(inside, -glm::dot(inside, kSmallCentre) + offset);
      scene.clipPlanes.emplace_back(0, 1, 0, -6.4);
      INFO("perspective " << (camera.projection == Projection::perspective) << ", cut " << offset);
      const Image exact = exactColour(grid, scene);
      CHECK(largestAlpha(exact) > 0.9);
      // As of slices (tests/shade/light_volume_gl_test.cpp): light is interpolated between voxels.
      CHECK(rmsDifference(renderedOnCpu(technique, grid, scene).colour, exact) < 0.02);
    }
}

TEST_CASE("Light of the world is kept while the camera moves", "[sweep][cpu][light-volume]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = litScene(ramp(0.7), smallCameras()[1]);
  scene.model = Model::lights;
  scene.lights = {{LightFrame::world, ConeLight{glm::dvec3(1, 1, 1), 0.3, glm::dvec3(1)}}};
  const auto bricks = cpuBricksFor(grid, scene);
  const auto rendererOf = [&](const ResolvedScene& of) -> std::unique_ptr<Renderer> {
    if (technique == Technique::rays) return std::make_unique<RayRenderer>(*bricks, of);
    return std::make_unique<ShearWarpRenderer>(*bricks, of);
  };
  const auto renderer = rendererOf(scene);
  CHECK(renderer->render().stats.uploadedBricks > 0);
  Camera moved = scene.camera;
  moved.eye += glm::dvec3(1, -2, 0.5);
  renderer->setCamera(moved);
  const Picture picture = renderer->render();
  CHECK(picture.stats.uploadedBricks == 0);
  CHECK(maxDifference(picture.colour, rendererOf(renderer->scene())->render().colour) == 0);
  renderer->setTransfer(ramp(0.9));
  CHECK(maxDifference(renderer->render().colour, rendererOf(renderer->scene())->render().colour) == 0);
  renderer->setClip({{0, 0, 1, -10}}, {});
  CHECK(maxDifference(renderer->render().colour, rendererOf(renderer->scene())->render().colour) == 0);
}
