// Hard cases of techniques on the CPU: media, grids and places.
// SPDX-License-Identifier: Apache-2.0
#include "support/closed_forms.h"
#include "sweep/picture_of_grid.h"

using namespace umbrick;

namespace {

// Of a field that is its own z: without its faces, where it falls to the background through all values.
const Box kInside{glm::dvec3(0.5), glm::dvec3(23.5)};

bool isFinite(const Image& image) {
  return std::all_of(image.pixels.begin(), image.pixels.end(), [](float v) { return std::isfinite(v) && v >= 0; });
}

}  // namespace

// Slabs that are thinner than a voxel lie between two slices: the table meets all of them.
TEST_CASE("Layers thinner than a voxel have their optical depth on the CPU", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid = fieldGrid({glm::ivec3(-1), glm::ivec3(25)}, [](const glm::dvec3& p) { return p.z; });
  const TransferFunction transfer({{9.3, {kAlbedo, 0}}, {9.3, {kAlbedo, 5}}, {9.5, {kAlbedo, 5}}, {9.5, {kAlbedo, 0}}});
  const Camera camera = orthographicCamera({12, 12, 60}, {12, 12, 0}, 10, 16);
  for (const int perVoxel : {1, 2, 3}) {
    ResolvedScene scene = plainScene(transfer, camera, 0.5);
    scene.clipBox = kInside;
    const Image picture = technique == Technique::rays
                              ? byRays(grid, scene, {}, perVoxel).colour
                              : shearWarped(grid, scene, {}, ShearWarpSampling{perVoxel, 1}).colour;
    // A step of the table is 1 / 20 000 of 0.2 units.
    CHECK(picture.at(8, 8)[3] == Approx(-std::expm1(-1.0)).margin(2e-3));
    CHECK(picture.at(8, 8)[0] == Approx(-kAlbedo.r * std::expm1(-1.0)).margin(2e-3));
  }
}

// The same of a function of value and gradient: between the voxels of a ramp, whose gradient is 1.
TEST_CASE("Layers of a 2D function that are thinner than a voxel have their optical depth on the CPU", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid = fieldGrid({glm::ivec3(-1), glm::ivec3(25)}, [](const glm::dvec3& p) { return p.z; });
  const Medium none{kAlbedo, 0}, some{kAlbedo, 50};
  // 0.02 of a voxel, in a domain of 30: less than a step of the table.
  const TransferFunction transfer({0, 9.3, 9.3, 9.32, 9.32, 30}, {0, 2},
                                  {none, none, some, some, none, none, none, none, some, some, none, none});
  ResolvedScene scene = plainScene(transfer, orthographicCamera({12, 12, 60}, {12, 12, 0}, 10, 16), 0.5);
  scene.clipBox = kInside;
  const Image picture = renderedOnCpu(technique, grid, scene).colour;
  CHECK(picture.at(8, 8)[3] == Approx(-std::expm1(-1.0)).margin(5e-3));
  CHECK(picture.at(8, 8)[0] == Approx(-kAlbedo.r * std::expm1(-1.0)).margin(5e-3));
}

TEST_CASE("Two slabs seen from both sides have their closed form on the CPU", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid = fieldGrid({glm::ivec3(-1), glm::ivec3(25)}, [](const glm::dvec3& p) { return p.z; });
  const TwoSlabs slabs;
  for (const bool above : {true, false})
    for (const glm::dvec2& tilt : {glm::dvec2(0), glm::dvec2(9, 4)}) {
      const glm::dvec3 offset(tilt, above ? 40 : -40);
      const Camera camera = orthographicCamera(glm::dvec3(12, 12, 12) + offset, {12, 12, 12}, 6, 8);
      ResolvedScene scene = plainScene(slabs.transfer, camera, 0.5);
      scene.clipBox = kInside;
      const Image picture = renderedOnCpu(technique, grid, scene).colour;
      const double stretch = glm::length(offset) / 40;
      const glm::dvec3 light = slabs.light(stretch, above);
      CAPTURE(above, tilt.x);
      CHECK(picture.at(4, 4)[3] == Approx(1 - TwoSlabs::transmittance(stretch)).margin(2e-3));
      for (int c = 0; c < 3; ++c) CHECK(picture.at(4, 4)[c] == Approx(light[c]).margin(3e-3));
    }
}

TEST_CASE("Extinction of 1e4 and 1e30 a voxel is opaque on the CPU and nothing else", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  for (const double sigma_t : {1e4, 1e30})
    for (const Camera& camera : smallCameras()) {
      ResolvedScene scene = plainScene(ramp(sigma_t, 0.2, 0.3), camera, 0.5);
      const Image picture = renderedOnCpu(technique, blobGrid(), scene).colour;
      CHECK(isFinite(picture));
      CHECK(largestAlpha(picture) == Approx(1).margin(1e-6));
      CHECK(rmsDifference(picture, renderReference(blobGrid(), scene).colour) < 0.1);  // edges, a ray wide
    }
}

TEST_CASE("Empty pictures of the CPU are empty, and a single voxel is seen", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid one = makeVoxels({{{5, 5, 5}, 1.0f}});
  Camera camera = orthographicCamera({5, 5, 20}, {5, 5, 5}, 4, 32);
  const ResolvedScene scene = plainScene(ramp(2), camera, 0.25);
  checkOnCpu(one, scene, 1e-4, 2e-2, 2e-3, 4);
  CHECK(largestAlpha(renderedOnCpu(technique, one, plainScene(ramp(2, 2, 3), camera, 0.5)).colour) == 0);
  camera.lookAt = {5, 5, 40};
  CHECK(largestAlpha(renderedOnCpu(technique, one, plainScene(ramp(2), camera, 0.5)).colour) == 0);
}

TEST_CASE("Grids of tiles and far from the origin approach the reference on the CPU", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  SECTION("tiles") {
    const ScalarGrid grid = makeTiles();
    Camera base;
    base.width = base.height = 24;
    const Camera camera = orbitCamera(grid.worldBounds(), 0.6, 0.4, base);
    checkOnCpu(grid, plainScene(ramp(0.01), camera, 1), 1e-4, 3e-2, 4e-3, 1);
  }
  SECTION("a million voxels from the origin") {
    const glm::ivec3 far(1000000, -1000000, 999999);
    Camera camera = smallCameras()[1];
    const Image near = renderedOnCpu(technique, blobGrid(), plainScene(ramp(0.6), camera, 0.5)).colour;
    camera.eye += glm::dvec3(far);
    camera.lookAt += glm::dvec3(far);
    // Places are known to 1e-10 of a voxel, and share of a voxel to a float's rounding.
    CHECK(maxDifference(renderedOnCpu(technique, blobGrid(far), plainScene(ramp(0.6), camera, 0.5)).colour, near) <
          1e-4);
  }
}

TEST_CASE("Thin fog in many slices keeps its opacity on the CPU", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid = makeFilled({24, 24, 1200}, {0, 0, 0}, [](const glm::ivec3&) { return 1.0; });
  const Camera camera = orthographicCamera({12, 12, 5000}, {12, 12, 0}, 6, 4);
  ResolvedScene scene = plainScene(homogeneous(kAlbedo, 1e-5), camera, 0.125);
  const Image picture = renderedOnCpu(technique, grid, scene).colour;  // some 9600 slices
  const Image exact = renderReference(grid, scene).colour;
  CHECK(picture.at(2, 2)[3] == Approx(exact.at(2, 2)[3]).epsilon(1e-4));
}

TEST_CASE("Pictures of few pixels see what their pixels see, however wide the view", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid = blobGrid();
  for (const double fov : {1.0, 2.0, 2.9})
    for (const glm::ivec2& size :
         {glm::ivec2(1, 1), glm::ivec2(1, 5), glm::ivec2(7, 1), glm::ivec2(3, 3), glm::ivec2(5, 6)})
      for (const glm::dvec3& eye : {glm::dvec3(12, 30, 12), glm::dvec3(12.5, 10.2, 15.5)}) {
        // Straight along an axis, so that rays lie in slices of the others.
        Camera camera = perspectiveCamera(eye, {eye.x, eye.y - 20, eye.z}, fov, 1);
        camera.up = {0, 0, 1};
        camera.width = size.x;
        camera.height = size.y;
        const ResolvedScene scene = plainScene(ramp(0.3), camera, 0.25);
        CAPTURE(fov, size.x, size.y, eye.y);
        const Image exact = renderReference(grid, scene).colour, picture = renderedOnCpu(technique, grid, scene).colour;
        CHECK(isFinite(picture));
        // The warp knows no more of a picture of a few pixels than its rays.
        CHECK(maxDifference(picture, exact) < (technique == Technique::rays ? 4e-3 : 2e-2));
      }
}

// Voxels beside the shell are 10 000 times its width away, in units of the value.
TEST_CASE("A shell that is thin for the values beside it has its optical depth", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid =
      fieldGrid({glm::ivec3(-1), glm::ivec3(25)}, [](const glm::dvec3& p) { return 1000 * (p.z - 11.5); });
  const TransferFunction transfer({{0, {kAlbedo, 0}}, {0.05, {kAlbedo, 8000}}, {0.1, {kAlbedo, 0}}});
  ResolvedScene scene = plainScene(transfer, orthographicCamera({12, 12, 60}, {12, 12, 0}, 10, 16), 1);
  scene.clipBox = kInside;
  const Image picture = renderedOnCpu(technique, grid, scene).colour;
  // 0.1 of 1000 units a voxel, at 4000 a voxel on average.
  CHECK(picture.at(8, 8)[3] == Approx(-std::expm1(-0.4)).margin(5e-3));
}

TEST_CASE("A scene that is refused leaves the renderer with the one before", "[sweep][cpu]") {
  const ScalarGrid grid = makeFilled(
      glm::ivec3(40), {3, 4, 5}, [](const glm::ivec3& i) { return 1 + 0.05 * i.x; }, 1);
  const Camera camera = orthographicCamera({60, 45, 70}, {22, 24, 25}, 60, 24);
  ResolvedScene scene = plainScene(TransferFunction({{1.5, {kAlbedo, 0}}, {3, {kAlbedo, 0.3}}}), camera, 1);
  const auto bricks = cpuBricksFor(grid, scene);
  RayRenderer rays(*bricks, scene);
  ShearWarpRenderer warped(*bricks, scene);
  for (Renderer* renderer : {static_cast<Renderer*>(&rays), static_cast<Renderer*>(&warped)}) {
    const Image before = renderer->render().colour;
    ResolvedScene other = scene;
    other.transfer = TransferFunction({{0, {kAlbedo, 0.1}}, {3, {kAlbedo, 0.3}}});  // the background is seen, too
    other.bricks.budgetMiB = 0;
    CHECK_THROWS_WITH(renderer->setScene(other), Catch::Contains("bricks.budgetMiB"));
    CHECK(maxDifference(renderer->render().colour, before) == 0);
  }
}
