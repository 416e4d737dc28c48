// Media that reflect light, on the CPU: against a closed form and the reference.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "support/observed_order.h"
#include "support/small_blobs.h"
#include "sweep/value_picture.h"
#include "umbrick/scene/shading_lights.h"
#include "umbrick/sweep/shear_warp_renderer.h"

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

}  // namespace

// Where the value is linear all central differences are its slope, and a constant medium of optical depth tau sends
// (1 - exp(-tau)) times what is reflected.
TEST_CASE("A medium of one slope reflects what Phong's model says", "[sweep][cpu][modes]") {
  const glm::dvec3 slope(0.02, 0.01, 0.04), albedo(0.8, 0.5, 0.25);
  const ScalarGrid grid =
      makeFilled(glm::ivec3(32), glm::ivec3(0), [&](const glm::ivec3& i) { return glm::dot(slope, glm::dvec3(i)); });
  ResolvedScene scene =
      shadedScene(TransferFunction({{0, {albedo, 0.1}}}), orthographicCamera({40, 30, 80}, glm::dvec3(15.5), 6, 8));
  scene.clipBox = Box{glm::dvec3(8), glm::dvec3(24)};
  for (const bool sources : {false, true}) {
    if (sources) addLights(scene);
    const Image colour = valuePicture(grid, scene, 2).colour;
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
    // Differences of floats, kept in 16 bits.
    CHECK(worst < 1e-4);
  }
}

TEST_CASE("A medium that reflects light is that of the reference, by rays and by shear-warp", "[sweep][cpu][modes]") {
  const ScalarGrid grid = withTransform(makeFilled(glm::ivec3(24), glm::ivec3(0), smallBlobs), crookedTransform());
  Camera base;
  base.width = base.height = 32;
  for (const Projection projection : {Projection::orthographic, Projection::perspective})
    for (const bool sources : {false, true}) {
      base.projection = projection;
      ResolvedScene scene = shadedScene(coloured(), orbitCamera(grid.worldBounds(), 1.7, 0.4, base));
      if (sources) addLights(scene);
      INFO("perspective " << (projection == Projection::perspective) << ", sources " << sources);
      const ReferencePicture reference = renderReference(grid, scene);
      const Image& exact = reference.colour;
      CHECK(largestAlpha(exact) > 0.5);
      CHECK(rmsDifference(valuePicture(grid, scene, 4, true).visibility, reference.visibility) < 1e-3);
      // Light counts as that of a segment's middle.
      CHECK(rmsDifference(valuePicture(grid, scene, 4).colour, exact) < 1e-3);
      const auto bricks = valueBricks(grid, scene);
      CHECK(rmsDifference(ShearWarpRenderer(*bricks, scene, {}, ShearWarpSampling{4, 4}).render().colour, exact) <
            3e-3);
      ResolvedScene unshaded = scene;
      unshaded.shading = {};
      CHECK(rmsDifference(valuePicture(grid, unshaded, 4).colour, exact) > 1e-2);
    }
}

TEST_CASE("Shading comes and goes with a renderer's scene", "[sweep][cpu][modes]") {
  const ScalarGrid grid = makeFilled(glm::ivec3(24), glm::ivec3(0), smallBlobs);
  const ResolvedScene shaded = shadedScene(coloured(), smallCameras().front());
  const auto bricks = valueBricks(grid, shaded);
  ResolvedScene plain = shaded, lit = shaded;
  lit.model = Model::cone;
  lit.method = Method::lightVolume;
  ResolvedScene both = lit;
  plain.shading = lit.shading = {};
  RayRenderer renderer(*bricks, lit);
  for (const ResolvedScene& scene : {lit, shaded, lit, both, lit, plain, both, shaded}) {
    renderer.setScene(scene);
    CHECK(maxDifference(renderer.render().colour, RayRenderer(*bricks, scene).render().colour) == 0);
  }
}

TEST_CASE("A medium that cannot reflect light is refused in one line", "[sweep][cpu][modes]") {
  const ScalarGrid grid = makeFilled(glm::ivec3(24), glm::ivec3(0), smallBlobs);
  ResolvedScene scene = shadedScene(coloured(), smallCameras().front());
  const auto bricks = valueBricks(grid, scene);
  const auto thin = cutGrid(grid, BrickOptions{.interior = 16, .apron = 1}, true);
  CHECK_THROWS_WITH(RayRenderer(*thin, scene), Contains("shading needs an apron of 2 voxels, found 1"));
  scene.shading.light = ShadingLight::sources;
  CHECK_THROWS_WITH(RayRenderer(*bricks, scene), Contains("shading.light: the scene has no directional source"));
  scene.shading.light = ShadingLight::automatic;
  ReferenceOptions options;
  options.integrator = Integrator::monteCarlo;
  CHECK_THROWS_WITH(renderReference(grid, scene, options), Contains("phong in a medium is integrated by quadrature"));
  CHECK_THROWS_WITH(requireMode(scene, Technique::slices),
                    "shading.kind: phong is not rendered by the technique slices but by rays, shear-warp");
}
