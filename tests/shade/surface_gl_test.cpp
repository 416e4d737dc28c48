// Isosurfaces by rays on OpenGL: against closed forms, rays on the CPU and the reference.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "shade/cast_grid.h"
#include "support/gl_fixture.h"
#include "support/observed_order.h"
#include "support/small_blobs.h"
#include "sweep/value_picture.h"
#include "umbrick/core/error.h"
#include "umbrick/image/image_difference.h"

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

// Places along a ray are single precision: of some hundred voxels, 1e-5 of a voxel each, a few of which add up along
// the way. That is the fraction of a voxel to which crossings are refined.
constexpr double kPlace = 1e-4;

// Compares positions with a distance function, and normals with its slope.
struct Errors {
  double position = 0, normal = 0;
  int hits = 0;
};
template <class Distance>
Errors errorsOf(const GlContext& context, const ScalarGrid& grid, const Camera& camera, const Distance& distance) {
  const Picture picture = castGrid(context, grid, surfaceScene(camera, {surfaceAt(0)}), true);
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

ScalarGrid surfaceBlobs() { return makeFilled(glm::ivec3(24), glm::ivec3(0), smallBlobs); }

// Returns how many pixels differ by more than the places of crossings explain.
int pixelsApart(const Image& a, const Image& b, double most) {
  int count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); i += 4) {
    double worst = 0;
    for (std::size_t c = 0; c < 4; ++c)
      worst = std::max(worst, std::abs(static_cast<double>(a.pixels[i + c]) - static_cast<double>(b.pixels[i + c])));
    count += worst > most;
  }
  return count;
}

}  // namespace

// See the test of rays on the CPU for what trilinear fields allow: of curvature k, 3/8 k of a voxel.
TEST_CASE("A plane, a sphere and a torus are met on OpenGL where they are", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.2, 0.4, 1));
  const auto plane = [&](const glm::dvec3& p) { return glm::dot(p, up) - 0.37; };
  const auto sphere = [](const glm::dvec3& p) { return glm::length(p - glm::dvec3(0.3, -0.2, 0.1)) - 17; };
  const auto torus = [](const glm::dvec3& p) {
    return glm::length(glm::dvec2(glm::length(glm::dvec2(p)) - 13, p.z)) - 6;
  };
  for (const Camera& camera :
       {orthographicCamera({32, 56, 80}, {0, 0, 0}, 44, 48), perspectiveCamera({-64, 40, 80}, {0, 0, 0}, 0.5, 48)}) {
    INFO("perspective " << (camera.projection == Projection::perspective));
    const Errors ofSphere = errorsOf(*context, gridOf(sphere), camera, sphere);
    const Errors ofTorus = errorsOf(*context, gridOf(torus), camera, torus);
    CHECK(ofSphere.hits > 500);
    CHECK(ofTorus.hits > 500);
    CHECK(ofSphere.position < 3.0 / 8 * 2 / 17);
    CHECK(ofSphere.normal < 0.02);
    CHECK(ofTorus.position < 3.0 / 8 * (1.0 / 6 + 1.0 / 7));
    CHECK(ofTorus.normal < 0.1);
  }
  // A distance that is linear in space is met to the rounding of places, away from the volume's faces.
  const Camera camera = orthographicCamera({20, 30, 80}, {0, 0, 0}, 20, 32);
  const Errors errors = errorsOf(*context, gridOf(plane), camera, plane);
  CHECK(errors.hits == 32 * 32);
  CHECK(errors.position < kPlace);
  CHECK(errors.normal < 1e-4);
}

TEST_CASE("Surfaces on OpenGL are those of rays on the CPU and of the reference", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = withTransform(surfaceBlobs(), crookedTransform());
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
      const Picture ours = castGrid(*context, grid, scene, true), theirs = valuePicture(grid, scene, {}, true);
      const ReferencePicture exact = renderReference(grid, scene);
      CHECK(largestAlpha(exact.colour) > 0.5);
      // Normals turn by a tenth or so from voxel to voxel, and a highlight's exponent is 20. Where a ray only just
      // touches a surface, rounding may make it miss.
      CHECK(pixelsApart(ours.colour, theirs.colour, 20 * 0.5 * kPlace) <= 1);
      CHECK(pixelsApart(ours.colour, exact.colour, 20 * 0.5 * kPlace) <= 1);
      CHECK(differenceOf(layerOf(ours, "value"), layerOf(exact, "value")).nonFiniteDiffering <= 1);
      CHECK(rmsDifference(ours.opacity, theirs.opacity) < 1e-2);
    }
}

TEST_CASE("A sheet that is thinner than a step, and a single voxel, are met on OpenGL", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid sheet = makeFilled(glm::ivec3(20), glm::ivec3(0), [](const glm::ivec3& i) { return i.z == 10; });
  ResolvedScene scene = surfaceScene(orthographicCamera({12, 14, 60}, {9.5, 9.5, 10}, 10, 24), {surfaceAt(0.98)});
  scene.sampling.spacing = 2;  // of no effect
  const Image seen = castGrid(*context, sheet, scene).colour;
  for (std::size_t i = 3; i < seen.pixels.size(); i += 4) CHECK(seen.pixels[i] == 1);
  const ScalarGrid voxel = makeVoxels({{{5, 5, 5}, 1.0f}});
  scene.camera = orthographicCamera({5, 5, 60}, {5, 5, 5}, 0.02, 8);
  const Image single = castGrid(*context, voxel, scene).colour;
  for (std::size_t i = 3; i < single.pixels.size(); i += 4) CHECK(single.pixels[i] == 1);
}

TEST_CASE("Transparent surfaces are composited on OpenGL in the order in which rays meet them",
          "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid =
      makeFilled(glm::ivec3(20), glm::ivec3(0), [](const glm::ivec3& i) { return 0.05 * (20 - i.z); });
  SceneSurface low{0.3, glm::dvec3(1, 0, 0), 0.5}, high{0.6, glm::dvec3(0, 1, 0), 0.25};
  ResolvedScene scene = surfaceScene(orthographicCamera({9.5, 9.5, 60}, {9.5, 9.5, 9.5}, 8, 4), {high, low});
  scene.camera.up = {0, 1, 0};
  scene.shading.kind = Shading::none;
  scene.clipBox = Box{{0, 0, 1}, {19, 19, 18}};
  const Image front = castGrid(*context, grid, scene).colour;
  CHECK(front.pixels[0] == Approx(0.5));
  CHECK(front.pixels[1] == Approx(0.5 * 0.25));
  CHECK(front.pixels[3] == Approx(0.5 + 0.5 * 0.25));
  scene.camera.eye.z = -40;
  const Image back = castGrid(*context, grid, scene).colour;
  CHECK(back.pixels[0] == Approx(0.75 * 0.5));
  CHECK(back.pixels[1] == Approx(0.25));
}

TEST_CASE("Bricks that are skipped, cut and drawn in runs change no surface on OpenGL", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeSparse(glm::ivec3(-5, 7, 2), 3, 12, 90);
  const glm::dvec3 centre = grid.worldBounds().centre();
  ResolvedScene scene =
      surfaceScene(perspectiveCamera(centre + glm::dvec3(70, 90, 120), centre, 0.7, 60), {surfaceAt(0.3, 0.5)});
  const Picture first = castGrid(*context, grid, scene, true);
  CHECK(largestAlpha(first.colour) > 0.5);
  AtlasLimits small;
  small.budgetBytes = first.stats.textureBytes / 5;
  const Picture inRuns = castGrid(*context, grid, scene, true, small);
  CHECK(inRuns.stats.textureBytes < first.stats.textureBytes / 2);
  const double most = 20 * 0.5 * kPlace;
  CHECK(pixelsApart(inRuns.colour, first.colour, most) <= 1);
  CHECK(differenceOf(layerOf(inRuns, "position"), layerOf(first, "position")).maxError < 10 * kPlace);
  CHECK(differenceOf(inRuns.depth, first.depth).maxError < 10 * kPlace);
  scene.bricks.culling = false;
  CHECK(pixelsApart(castGrid(*context, grid, scene).colour, first.colour, most) <= 1);
  scene.bricks.bricked = false;
  CHECK(pixelsApart(castGrid(*context, grid, scene).colour, first.colour, most) <= 1);
}

TEST_CASE("A level set is met on OpenGL where its sphere is, also from within", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const double voxel = 0.5;
  const glm::dvec3 centre(1, 2, 3);
  const ScalarGrid grid = makeSphereLevelSet(12, voxel, centre);
  for (const Camera& camera :
       {orthographicCamera({40, 30, 50}, centre, 20, 40), perspectiveCamera({40, 30, 50}, centre, 0.3, 40),
        perspectiveCamera({2, 4, 1}, {9, 5, 2}, 1.9, 40)}) {
    const Picture picture = castGrid(*context, grid, surfaceScene(camera, {surfaceAt(0)}), true);
    const Image& position = layerOf(picture, "position");
    double worst = 0;
    int hits = 0;
    for (int i = 0; i < 40 * 40; ++i) {
      const float* const p = &position.pixels[static_cast<std::size_t>(3 * i)];
      if (std::isnan(p[0])) continue;
      ++hits;
      worst = std::max(worst, std::abs(glm::length(glm::dvec3(p[0], p[1], p[2]) - centre) - 12));
    }
    CHECK(hits > 1000);
    CHECK(worst < 3.0 / 8 * 2 * voxel / 12 * voxel + kPlace);
  }
}

TEST_CASE("What has no surface or no light is refused on OpenGL in one line", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = surfaceBlobs();
  ResolvedScene scene = surfaceScene(smallCameras().front(), {surfaceAt(5)});
  CHECK_THROWS_WITH(castGrid(*context, grid, scene),
                    Contains("surfaces[0].value: 5 has no surface, the volume has values from 0 to "));
  scene.surfaces.clear();
  CHECK_THROWS_WITH(castGrid(*context, grid, scene), Contains("surfaces: is empty"));
  scene.surfaces = {surfaceAt(0.4)};
  scene.shading.light = ShadingLight::sources;
  CHECK_THROWS_WITH(castGrid(*context, grid, scene), Contains("shading.light: the scene has no directional source"));
  scene.shading = {};
  const auto bricks = cutGrid(grid, BrickOptions{.interior = 16, .apron = 1}, true);
  CHECK_THROWS_WITH(RayCaster(*context, *bricks, scene), Contains("surfaces need an apron of 2 voxels, found 1"));
  scene.mode = Mode::mip;
  scene.shading.kind = Shading::phong;
  CHECK_THROWS_WITH(RayCaster(*context, *bricks, scene), Contains("shading.kind: phong is for surfaces and media"));
}
