// Isosurfaces by rays on the CPU: against closed forms, OpenVDB's rays and the reference.
// SPDX-License-Identifier: Apache-2.0
#include <openvdb/tools/RayIntersector.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "support/observed_order.h"
#include "support/small_blobs.h"
#include "sweep/cell_cubic.h"
#include "sweep/value_picture.h"
#include "umbrick/core/error.h"
#include "umbrick/image/image_difference.h"
#include "umbrick/sweep/shear_warp_renderer.h"

using namespace umbrick;
using Catch::Contains;

namespace {

TransferFunction twoColours() { return TransferFunction({{0, {{1, 0.5, 0.2}, 1}}, {1, {{0.2, 0.6, 1}, 1}}}); }

ResolvedScene surfaceScene(const Camera& camera, std::vector<SceneSurface> surfaces) {
  ResolvedScene scene = plainScene(twoColours(), camera, 0.5);
  scene.mode = Mode::isosurface;
  scene.surfaces = std::move(surfaces);
  return scene;
}

// Compares each depth with the distance function's own root, which is found from there by its slope.
struct Errors {
  double position = 0, normal = 0;
  int hits = 0;
};
template <class Distance>
Errors errorsOf(const ScalarGrid& grid, const Camera& camera, const Distance& distance) {
  const Picture picture = valuePicture(grid, surfaceScene(camera, {surfaceAt(0)}), {}, true);
  const Image &position = layerOf(picture, "position"), &normal = layerOf(picture, "normal");
  Errors errors;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const float *p = position.at(x, y), *n = normal.at(x, y);
      if (std::isnan(p[0])) continue;
      const glm::dvec3 at(p[0], p[1], p[2]);
      glm::dvec3 slope;
      for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 step(0);
        step[axis] = 1e-4;
        slope[axis] = (distance(at + step) - distance(at - step)) / 2e-4;
      }
      ++errors.hits;
      errors.position = std::max(errors.position, std::abs(distance(at)));
      // A normal is on the viewer's side, which at the silhouette may be the other one.
      const glm::dvec3 ours(n[0], n[1], n[2]), theirs = glm::normalize(slope);
      errors.normal = std::max(errors.normal, std::min(glm::length(ours - theirs), glm::length(ours + theirs)));
    }
  return errors;
}

template <class Distance>
ScalarGrid gridOf(const Distance& distance) {
  return makeFilled(
      glm::ivec3(48), glm::ivec3(-24), [&](const glm::ivec3& i) { return distance(glm::dvec3(i - 24)); }, 9);
}

std::vector<Camera> camerasAround(double reach, int size) {
  return {orthographicCamera({0.4 * reach, 0.7 * reach, reach}, {0, 0, 0}, 44, size),
          perspectiveCamera({-0.8 * reach, 0.5 * reach, reach}, {0, 0, 0}, 0.5, size)};
}

}  // namespace

TEST_CASE("A cubic's crossings are found, all of them and in order", "[sweep][modes]") {
  TestRandom random(5);
  int found = 0;
  for (int i = 0; i < 20000; ++i) {
    CellCorners corners;
    for (double& corner : corners) corner = random.uniform(-1, 1);
    const glm::dvec3 from = random.point(glm::dvec3(0), glm::dvec3(1)), to = random.point(glm::dvec3(0), glm::dvec3(1));
    const CellCubic cubic = cubicBetween(corners, from, to);
    const CellCrossings crossings = crossingsOf(cubic, 0, cubic(0) > 0);
    // Brute force at many places misses no more than pairs that are closer than its steps.
    int changes = 0;
    bool above = cubic(0) > 0;
    for (int k = 1; k <= 1000; ++k)
      if ((cubic(k / 1000.0) > 0) != above) {
        above = !above;
        ++changes;
      }
    CHECK(crossings.count >= changes);
    CHECK((crossings.count - changes) % 2 == 0);
    for (int k = 0; k < crossings.count; ++k) {
      const double s = crossings.places[static_cast<std::size_t>(k)];
      CHECK(std::abs(cubic(s)) < 1e-9);
      if (k > 0) CHECK(s >= crossings.places[static_cast<std::size_t>(k - 1)]);
    }
    CHECK(crossings.above == (cubic(1) > 0));
    found += crossings.count;
  }
  CHECK(found > 5000);
}

// A field is trilinear between voxels, which are floats: a distance that is linear in space is met to a float's
// rounding, and one of curvature k is off by up to 3/8 k h^2, where neighbours lie on a chord.
TEST_CASE("A plane, a sphere and a torus are met where they are", "[sweep][cpu][modes]") {
  for (const Camera& camera : camerasAround(80, 48)) {
    INFO("perspective " << (camera.projection == Projection::perspective));
    const glm::dvec3 up = glm::normalize(glm::dvec3(0.2, 0.4, 1));
    const auto plane = [&](const glm::dvec3& p) { return glm::dot(p, up) - 0.37; };
    const auto sphere = [](const glm::dvec3& p) { return glm::length(p - glm::dvec3(0.3, -0.2, 0.1)) - 17; };
    const auto torus = [](const glm::dvec3& p) {
      return glm::length(glm::dvec2(glm::length(glm::dvec2(p)) - 13, p.z)) - 6;
    };
    const Errors ofPlane = errorsOf(gridOf(plane), camera, plane);
    const Errors ofSphere = errorsOf(gridOf(sphere), camera, sphere);
    const Errors ofTorus = errorsOf(gridOf(torus), camera, torus);
    CHECK(ofSphere.hits > 500);
    CHECK(ofTorus.hits > 500);
    CHECK(ofSphere.position < 3.0 / 8 * 2 / 17);
    CHECK(ofSphere.normal < 0.02);
    CHECK(ofTorus.position < 3.0 / 8 * (1.0 / 6 + 1.0 / 7));
    CHECK(ofTorus.normal < 0.1);
    // The volume ends with a step to the background, through which the surface goes on; inside it is the plane.
    CHECK(ofPlane.hits > 700);
  }
  // Within the volume alone, away from its faces.
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.2, 0.4, 1));
  const auto plane = [&](const glm::dvec3& p) { return glm::dot(p, up) - 0.37; };
  Camera camera = orthographicCamera({20, 30, 80}, {0, 0, 0}, 20, 32);
  const Errors errors = errorsOf(gridOf(plane), camera, plane);
  CHECK(errors.hits == 32 * 32);
  CHECK(errors.position < 1e-5);
  CHECK(errors.normal < 1e-5);
}

TEST_CASE("A level set is met where OpenVDB's own rays meet it", "[sweep][cpu][modes]") {
  const double voxel = 0.5;
  const ScalarGrid grid = makeSphereLevelSet(12, voxel, {1, 2, 3});
  const openvdb::tools::LevelSetRayIntersector<openvdb::FloatGrid> theirs(*grid.grid);
  for (const Camera& camera :
       {orthographicCamera({40, 30, 50}, {1, 2, 3}, 26, 40), perspectiveCamera({40, 30, 50}, {1, 2, 3}, 0.4, 40)}) {
    const Picture picture = valuePicture(grid, surfaceScene(camera, {surfaceAt(0)}), {}, true);
    const Image& position = layerOf(picture, "position");
    int both = 0, one = 0;
    double worst = 0;
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        const ViewRay ray = viewRay(camera, x + 0.5, y + 0.5);
        const auto vector = [](const glm::dvec3& v) { return openvdb::Vec3d(v.x, v.y, v.z); };
        openvdb::Vec3d hit;
        const bool met = theirs.intersectsWS(
            openvdb::math::Ray<double>(vector(ray.origin), vector(glm::normalize(ray.direction))), hit);
        const float* const ours = position.at(x, y);
        if (met == std::isnan(ours[0])) ++one;
        if (!met || std::isnan(ours[0])) continue;
        ++both;
        // Across the surface: along a ray that grazes it, a little is far.
        const glm::dvec3 centre(1, 2, 3);
        worst = std::max(worst, std::abs(glm::length(glm::dvec3(hit.x(), hit.y(), hit.z()) - centre) -
                                         glm::length(glm::dvec3(ours[0], ours[1], ours[2]) - centre)));
      }
    CHECK(both > 500);
    CHECK(one <= 2);  // at the silhouette
    // OpenVDB takes the value as linear between samples that are half a voxel apart or so.
    CHECK(worst < 0.05 * voxel);
  }
}

TEST_CASE("Surfaces are those of the reference", "[sweep][cpu][modes]") {
  const ScalarGrid grid = withTransform(makeFilled(glm::ivec3(24), glm::ivec3(0), smallBlobs), crookedTransform());
  Camera base;
  base.width = base.height = 40;
  for (const Projection projection : {Projection::orthographic, Projection::perspective})
    for (const double azimuth : {0.3, 1.7, 3.9}) {
      base.projection = projection;
      ResolvedScene scene =
          surfaceScene(orbitCamera(grid.worldBounds(), azimuth, 0.4, base), {surfaceAt(0.5, 0.6), surfaceAt(0.2, 0.4)});
      scene.ambient = {0.9, 0.8, 0.7};
      scene.shading.specular = 0.5;
      INFO("azimuth " << azimuth << ", perspective " << (projection == Projection::perspective));
      SECTION("as they are") {}
      SECTION("clipped") { scene.clipPlanes = {{0, 0, 1, -grid.worldBounds().centre().z}}; }
      SECTION("flat") { scene.shading.kind = Shading::none; }
      SECTION("under lights of the world and of the view") {
        scene.shading.light = ShadingLight::sources;
        scene.lights = {{LightFrame::world, ConeLight{{1, 2, 3}, 0, {1, 0.7, 0.2}}},
                        {LightFrame::view, ConeLight{{-1, 0.5, 1}, 0, {0, 0.2, 0.5}}}};
      }
      SECTION("by several samples a pixel") { scene.sampling.pixelSamples = 3; }
      SECTION("over a background") { scene.background = glm::dvec3(0.1, 0.2, 0.3); }
      const Picture ours = valuePicture(grid, scene, {}, true);
      const ReferencePicture exact = renderReference(grid, scene);
      CHECK(largestAlpha(exact.colour) > 0.5);
      CHECK(maxDifference(ours.colour, exact.colour) < 1e-5);
      CHECK(differenceOf(layerOf(ours, "value"), layerOf(exact, "value")).nonFiniteDiffering == 0);
      CHECK(differenceOf(layerOf(ours, "position"), layerOf(exact, "position")).maxError < 1e-3);
      CHECK(differenceOf(layerOf(ours, "normal"), layerOf(exact, "normal")).maxError < 1e-4);
      CHECK(differenceOf(ours.depth, exact.depth).maxError < 1e-3);
    }
}

TEST_CASE("A sheet that is thinner than a step, and a single voxel, are met", "[sweep][cpu][modes]") {
  const ScalarGrid sheet = makeFilled(glm::ivec3(20), glm::ivec3(0), [](const glm::ivec3& i) { return i.z == 10; });
  ResolvedScene scene = surfaceScene(orthographicCamera({12, 14, 60}, {9.5, 9.5, 10}, 10, 24), {surfaceAt(0.98)});
  scene.sampling.spacing = 5;  // of no effect
  const Image seen = valuePicture(sheet, scene).colour;
  for (std::size_t i = 3; i < seen.pixels.size(); i += 4) CHECK(seen.pixels[i] == 1);
  const ScalarGrid voxel = makeVoxels({{{5, 5, 5}, 1.0f}});
  scene.camera = orthographicCamera({5, 5, 60}, {5, 5, 5}, 0.02, 8);
  for (std::size_t i = 3; i < 8 * 8 * 4; i += 4) CHECK(valuePicture(voxel, scene).colour.pixels[i] == 1);
}

TEST_CASE("Transparent surfaces are composited in the order in which rays meet them", "[sweep][cpu][modes]") {
  const ScalarGrid grid =
      makeFilled(glm::ivec3(20), glm::ivec3(0), [](const glm::ivec3& i) { return 0.05 * (20 - i.z); });
  SceneSurface low{0.3, glm::dvec3(1, 0, 0), 0.5}, high{0.6, glm::dvec3(0, 1, 0), 0.25};
  ResolvedScene scene = surfaceScene(orthographicCamera({9.5, 9.5, 60}, {9.5, 9.5, 9.5}, 8, 4), {high, low});
  scene.camera.up = {0, 1, 0};
  scene.shading.kind = Shading::none;
  scene.clipBox = Box{{0, 0, 1}, {19, 19, 18}};
  const Image front = valuePicture(grid, scene).colour;
  CHECK(front.pixels[0] == Approx(0.5));
  CHECK(front.pixels[1] == Approx(0.5 * 0.25));
  CHECK(front.pixels[3] == Approx(0.5 + 0.5 * 0.25));
  scene.camera.eye.z = -40;
  const Image back = valuePicture(grid, scene).colour;
  CHECK(back.pixels[0] == Approx(0.75 * 0.5));
  CHECK(back.pixels[1] == Approx(0.25));
}

TEST_CASE("Bricks that are skipped and cut change no surface", "[sweep][cpu][modes]") {
  const ScalarGrid grid = makeSparse(glm::ivec3(-5, 7, 2), 3, 12, 90);
  const glm::dvec3 centre = grid.worldBounds().centre();
  ResolvedScene scene =
      surfaceScene(perspectiveCamera(centre + glm::dvec3(70, 90, 120), centre, 0.7, 60), {surfaceAt(0.3, 0.5)});
  const Image skipped = valuePicture(grid, scene).colour;
  CHECK(largestAlpha(skipped) > 0.5);
  scene.bricks.culling = false;
  CHECK(maxDifference(valuePicture(grid, scene).colour, skipped) == 0);
  scene.bricks.bricked = false;
  CHECK(maxDifference(valuePicture(grid, scene).colour, skipped) < 1e-6);
}

TEST_CASE("Phong's highlight lies where the light is mirrored", "[sweep][cpu][modes]") {
  const auto sphere = [](const glm::dvec3& p) { return 17 - glm::length(p); };
  const ScalarGrid grid = makeFilled(
      glm::ivec3(48), glm::ivec3(-24), [&](const glm::ivec3& i) { return sphere(i - 24); }, -9);
  ResolvedScene scene =
      surfaceScene(orthographicCamera({0, 0, 80}, {0, 0, 0}, 40, 81), {{0, glm::dvec3(0.5, 0.4, 0.3), 1}});
  scene.camera.up = {0, 1, 0};
  scene.shading = {Shading::phong, ShadingLight::automatic, 0.1, 0.6, 0.3, 15};
  const auto at = [](const Image& image, int x, int y) { return image.at(x, y)[0]; };
  // A headlight is mirrored in the middle, where all of it comes back.
  CHECK(at(valuePicture(grid, scene).colour, 40, 40) == Approx(0.5 * (0.1 + 0.6) + 0.3).epsilon(1e-3));
  // A light from 60 degrees to the right is mirrored where the surface faces 30 degrees: at 17 sin 30, 17.2 pixels.
  scene.shading.light = ShadingLight::sources;
  scene.lights = {{LightFrame::view, ConeLight{{std::sqrt(3.0), 0, 1}, 0, glm::dvec3(1)}}};
  const Image lit = valuePicture(grid, scene).colour;
  const double cos30 = std::sqrt(0.75);
  CHECK(at(lit, 57, 40) == Approx(0.5 * (0.1 + 0.6 * cos30) + 0.3).epsilon(0.02));
  CHECK(at(lit, 10, 40) == Approx(0.5 * 0.1).epsilon(1e-3));  // it does not see the light
}

TEST_CASE("What has no surface, no light or no such mode is refused in one line", "[sweep][cpu][modes]") {
  const ScalarGrid grid = makeFilled(glm::ivec3(24), glm::ivec3(0), smallBlobs);
  ResolvedScene scene = surfaceScene(smallCameras().front(), {surfaceAt(5)});
  CHECK_THROWS_WITH(valuePicture(grid, scene),
                    Contains("surfaces[0].value: 5 has no surface, the volume has values from 0 to "));
  CHECK_THROWS_WITH(renderReference(grid, scene), Contains("surfaces[0].value: 5 has no surface"));
  scene.surfaces.clear();
  CHECK_THROWS_WITH(valuePicture(grid, scene), Contains("surfaces: is empty"));
  scene.surfaces = {surfaceAt(0.4)};
  scene.shading.light = ShadingLight::sources;
  CHECK_THROWS_WITH(valuePicture(grid, scene), Contains("shading.light: the scene has no directional source"));
  CHECK_THROWS_WITH(renderReference(grid, scene), Contains("shading.light: the scene has no directional source"));
  scene.shading = {};
  const auto bricks = cutGrid(grid, BrickOptions{.interior = 16, .apron = 1}, true);
  CHECK_THROWS_WITH(RayRenderer(*bricks, scene), Contains("surfaces need an apron of 2 voxels, found 1"));
  scene.mode = Mode::mip;
  CHECK_THROWS_WITH(ShearWarpRenderer(*bricks, scene),
                    "mode: mip is not rendered by the technique shear-warp but by rays");
  scene.shading.kind = Shading::phong;
  CHECK_THROWS_WITH(RayRenderer(*bricks, scene), Contains("shading.kind: phong is for surfaces and media"));
}
