// Pictures made on the CPU with light from light volumes.
// SPDX-License-Identifier: Apache-2.0
#include "sweep/picture_of_grid.h"
#include "umbrick/scene/lights.h"

using namespace umbrick;

namespace {

ScalarGrid blobGrid() { return makeFilled(glm::ivec3(24), {0, 0, 0}, smallBlobs); }

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
