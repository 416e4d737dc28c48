// Gradients by B-splines in pictures of the CPU: against closed forms, central differences and the reference.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "support/observed_order.h"
#include "support/small_blobs.h"
#include "sweep/value_picture.h"
#include "umbrick/core/error.h"
#include "umbrick/image/image_difference.h"
#include "umbrick/sweep/shear_warp_renderer.h"

using namespace umbrick;
using Catch::Contains;

namespace {

TransferFunction splineMedium() {
  return TransferFunction({{0.05, {{0.9, 0.6, 0.3}, 0}}, {1, {{0.4, 0.7, 0.9}, 0.8}}});
}

ResolvedScene splineScene(const Camera& camera) {
  ResolvedScene scene = plainScene(splineMedium(), camera, 0.5);
  scene.gradients = GradientFilter::bspline;
  return scene;
}

ResolvedScene splineSurface(const Camera& camera, std::vector<SceneSurface> surfaces) {
  ResolvedScene scene = splineScene(camera);
  scene.mode = Mode::isosurface;
  scene.surfaces = std::move(surfaces);
  return scene;
}

ResolvedScene withCentral(ResolvedScene scene) {
  scene.gradients = GradientFilter::central;
  return scene;
}

ScalarGrid crookedBlobs() {
  return withTransform(makeFilled(glm::ivec3(24), glm::ivec3(0), smallBlobs), crookedTransform());
}

Camera orbitOf(const ScalarGrid& grid, Projection projection, int size) {
  Camera base;
  base.width = base.height = size;
  base.projection = projection;
  return orbitCamera(grid.worldBounds(), 1.7, 0.4, base);
}

// What is 2D because it appears with the gradient.
ResolvedScene withRamp(ResolvedScene scene) {
  scene.gradientOpacity = {0.03, 0.13};
  scene.transfer = withGradientOpacity(scene.transfer, scene.gradientOpacity);
  return scene;
}

}  // namespace

// The spline of the voxels x^3 / 64 has the slope (3 x^2 + 1) / 64, and what is interpolated of central differences
// exceeds it by 3 t (1 - t) / 64 at a place t between voxels.
TEST_CASE("A surface's normals are the spline's own between voxels", "[sweep][cpu][modes]") {
  const auto field = [](const glm::ivec3& i) {
    const double x = i.x - 8;
    return x * x * x / 64 + i.y;
  };
  const ScalarGrid grid = makeFilled(glm::ivec3(17, 33, 17), glm::ivec3(0), field, -20);
  ResolvedScene scene = splineSurface(orthographicCamera({8.4, -50, 8.3}, {8.4, 10, 8.3}, 7, 24), {surfaceAt(14)});
  scene.camera.up = {0, 0, 1};
  const Picture spline = valuePicture(grid, scene, {}, true),
                central = valuePicture(grid, withCentral(scene), {}, true);
  CHECK(maxDifference(layerOf(spline, "position"), layerOf(central, "position")) == 0);
  double worst = 0, centralWorst = 0;
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x) {
      const float* const at = layerOf(spline, "position").at(x, y);
      REQUIRE(std::isfinite(at[0]));
      const double from = at[0] - 8.0, t = from - std::floor(from), slope = (3 * from * from + 1) / 64;
      const auto off = [&](const Picture& picture, double along) {
        const float* const n = layerOf(picture, "normal").at(x, y);
        return glm::length(glm::dvec3(n[0], n[1], n[2]) + glm::normalize(glm::dvec3(along, 1, 0)));
      };
      worst = std::max(worst, off(spline, slope));
      centralWorst = std::max(centralWorst, off(central, slope + 3 * t * (1 - t) / 64));
    }
  CHECK(worst < 1e-5);  // of single precision
  CHECK(centralWorst < 1e-5);
}

TEST_CASE("Where values are linear, gradients of both kinds give one picture", "[sweep][cpu][modes]") {
  const glm::dvec3 slope(0.02, 0.01, 0.04);
  const ScalarGrid grid =
      makeFilled(glm::ivec3(32), glm::ivec3(0), [&](const glm::ivec3& i) { return glm::dot(slope, glm::dvec3(i)); });
  ResolvedScene scene = splineScene(orthographicCamera({40, 30, 80}, glm::dvec3(15.5), 14, 16));
  scene.clipBox = Box{glm::dvec3(8), glm::dvec3(24)};
  SECTION("a medium that reflects light") { scene.shading.kind = Shading::phong; }
  SECTION("a surface") {
    scene.mode = Mode::isosurface;
    scene.surfaces = {surfaceAt(1)};
  }
  SECTION("a medium that appears with the gradient") { scene = withRamp(scene); }
  const Image spline = valuePicture(grid, scene).colour;
  CHECK(largestAlpha(spline) > 0.3);
  CHECK(maxDifference(spline, valuePicture(grid, withCentral(scene)).colour) < 1e-4);  // as in shading_test.cpp
}

TEST_CASE("Gradients by B-splines are those of the reference", "[sweep][cpu][modes]") {
  const ScalarGrid grid = crookedBlobs();
  for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
    const Camera camera = orbitOf(grid, projection, 24);
    INFO("perspective " << (projection == Projection::perspective));
    ResolvedScene surfaces = splineSurface(camera, {surfaceAt(0.5, 0.6), surfaceAt(0.2, 0.4)});
    const Picture seen = valuePicture(grid, surfaces, {}, true);
    const ReferencePicture exactSurfaces = renderReference(grid, surfaces);
    CHECK(maxDifference(seen.colour, exactSurfaces.colour) < 1e-5);
    CHECK(differenceOf(layerOf(seen, "normal"), layerOf(exactSurfaces, "normal")).maxError < 1e-4);
    CHECK(rmsDifference(seen.colour, valuePicture(grid, withCentral(surfaces)).colour) > 5e-4);

    ResolvedScene shaded = splineScene(camera), ramp = withRamp(splineScene(camera));
    shaded.shading = {Shading::phong, ShadingLight::automatic, 0.15, 0.7, 0.4, 8};
    for (const ResolvedScene& medium : {shaded, ramp}) {
      INFO("2D " << medium.transfer.is2d());
      const Image exact = renderReference(grid, medium).colour;
      CHECK(largestAlpha(exact) > 0.3);
      const auto bricks = valueBricks(grid, medium);
      const Image shear = ShearWarpRenderer(*bricks, medium, {}, ShearWarpSampling{4, 4}).render().colour;
      // Light and gradients count as those of a segment's middle.
      const double off = rmsDifference(valuePicture(grid, medium, 4).colour, exact);
      CHECK(off < 1e-3);
      CHECK(rmsDifference(shear, exact) < 3e-3);
      CHECK(off < rmsDifference(valuePicture(grid, withCentral(medium), 4).colour, exact));
    }
  }
}

TEST_CASE("Bricks change nothing of gradients by B-splines", "[sweep][cpu][modes]") {
  const ScalarGrid grid = makeSparse(glm::ivec3(-5, 7, 2), 3, 12, 90);
  const glm::dvec3 centre = grid.worldBounds().centre();
  const Camera camera = perspectiveCamera(centre + glm::dvec3(70, 90, 120), centre, 0.7, 40);
  ResolvedScene shaded = splineScene(camera);
  shaded.shading.kind = Shading::phong;
  for (ResolvedScene scene : {splineSurface(camera, {surfaceAt(0.3, 0.5)}), shaded, withRamp(splineScene(camera))}) {
    const Image cut = valuePicture(grid, scene).colour;
    CHECK(largestAlpha(cut) > 0.1);
    scene.bricks.culling = false;
    CHECK(maxDifference(valuePicture(grid, scene).colour, cut) < 1e-6);
    scene.bricks.bricked = false;
    CHECK(maxDifference(valuePicture(grid, scene).colour, cut) < 1e-6);
  }
}

TEST_CASE("The kind of gradients comes and goes with a scene, and bricks of the other kind are refused",
          "[sweep][cpu][modes]") {
  const ScalarGrid grid = crookedBlobs();
  ResolvedScene shaded = splineScene(orbitOf(grid, Projection::perspective, 24));
  shaded.shading.kind = Shading::phong;
  const ResolvedScene surface = splineSurface(shaded.camera, {surfaceAt(0.4)});
  const auto bricks = valueBricks(grid, surface);
  RayRenderer renderer(*bricks, shaded);
  for (const ResolvedScene& scene :
       {withCentral(shaded), shaded, surface, withCentral(surface), shaded, withCentral(surface), surface}) {
    renderer.setScene(scene);
    CHECK(maxDifference(renderer.render().colour, RayRenderer(*bricks, scene).render().colour) == 0);
  }
  const ResolvedScene ramp = withRamp(shaded);
  const auto others = valueBricks(grid, withCentral(ramp));
  CHECK_THROWS_WITH(RayRenderer(*others, ramp),
                    Contains("gradients: is bspline, bricks have those of the kind central"));
}
