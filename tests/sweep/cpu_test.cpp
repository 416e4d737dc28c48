// Pictures made on the CPU, by rays and by shear-warp: against the reference, and what must not change them.
// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "core/baseline_instructions.h"
#include "support/random_transfer.h"
#include "sweep/picture_of_grid.h"
#include "umbrick/core/error.h"

using namespace umbrick;

namespace {

ResolvedScene blobScene(const Camera& camera, double sigma_t = 0.6) { return plainScene(ramp(sigma_t), camera, 0.5); }

// Cameras all around, so that each axis is the main one in both directions.
std::vector<Camera> camerasAround(int size = 32) {
  std::vector<Camera> cameras;
  for (const glm::dvec3& from : {glm::dvec3(30, 6, 8), glm::dvec3(-30, 5, -9), glm::dvec3(7, 30, -8),
                                 glm::dvec3(4, -30, 7), glm::dvec3(9, -4, 30), glm::dvec3(-6, 8, -30)}) {
    cameras.push_back(orthographicCamera(kSmallCentre + from, kSmallCentre, 30, size));
    cameras.push_back(perspectiveCamera(kSmallCentre + from, kSmallCentre, 0.6, size));
  }
  return cameras;
}

}  // namespace

TEST_CASE("Pictures along each axis approach the reference", "[sweep][cpu]") {
  const ScalarGrid grid = blobGrid();
  for (const Camera& camera : camerasAround()) {
    INFO("eye " << camera.eye.x << " " << camera.eye.y << " " << camera.eye.z << ", perspective "
                << (camera.projection == Projection::perspective));
    checkOnCpu(grid, blobScene(camera));
  }
}

TEST_CASE("Rotated, anisotropic, sheared and mirrored grids approach the reference on the CPU", "[sweep][cpu]") {
  const ScalarGrid grid = withTransform(blobGrid(), crookedTransform());
  Camera base;
  base.width = base.height = 32;
  for (const Projection projection : {Projection::orthographic, Projection::perspective})
    for (const double azimuth : {0.3, 1.7, 3.9}) {
      base.projection = projection;
      const Camera camera = orbitCamera(grid.worldBounds(), azimuth, 0.4, base);
      INFO("azimuth " << azimuth << ", perspective " << (projection == Projection::perspective));
      checkOnCpu(grid, plainScene(ramp(0.6), camera, 0.5));
    }
}

TEST_CASE("An eye within the volume, and views of more than 90 degrees, approach the reference", "[sweep][cpu]") {
  const ScalarGrid grid = blobGrid();
  for (const double fov : {0.5, 1.4, 2.4})
    for (const glm::dvec3& eye : {glm::dvec3(12.3, 9.1, 17.2), glm::dvec3(12, 9, 17), glm::dvec3(3.5, 20.2, 5.1)}) {
      const Camera camera = perspectiveCamera(eye, kSmallCentre + glm::dvec3(0.3, 0.5, -1), fov, 32);
      INFO("fov " << fov << ", eye " << eye.x << " " << eye.y << " " << eye.z);
      // Rays of neighbouring pixels part beside the eye, so that kinks of the field are sharp in the picture.
      checkOnCpu(grid, blobScene(camera, 0.2), 2e-4, 2e-2, 2e-3);
    }
}

TEST_CASE("Clip planes, clip box and near plane cut pictures of the CPU at their place", "[sweep][cpu]") {
  const ScalarGrid grid = blobGrid();
  for (const Camera& camera : smallCameras()) {
    ResolvedScene scene = blobScene(camera);
    SECTION("planes") { scene.clipPlanes = {{0.3, -0.5, -0.8, 14}, {0, 1, 0, -5.3}}; }
    SECTION("box") { scene.clipBox = Box{{4.2, 5.1, 3}, {17.5, 16.3, 14.9}}; }
    SECTION("near plane") { scene.camera.nearDistance = 33; }
    // Pictures have an edge there, which the warp blurs by a ray.
    checkOnCpu(grid, scene, 1e-4, 2e-2, 2e-3);
  }
}

TEST_CASE("A background that is seen ends where the medium does, on the CPU", "[sweep][cpu]") {
  const ScalarGrid grid = makeFilled(
      glm::ivec3(20), {3, 4, 5}, [](const glm::ivec3& i) { return 1 + 0.05 * i.x; }, 1);
  for (const Camera& camera : smallCameras())
    checkOnCpu(grid, plainScene(TransferFunction({{0, {kAlbedo, 0}}, {2, {kAlbedo, 0.1}}}), camera, 0.5), 1e-4, 3e-2,
               4e-3);
}

TEST_CASE("A 2D function approaches the reference on the CPU", "[sweep][cpu]") {
  const ScalarGrid grid = blobGrid();
  const Medium none{kAlbedo, 0}, some{{0.2, 0.9, 0.4}, 0.8};
  const TransferFunction transfer({0, 0.3, 1}, {0, 0.05, 0.2}, {none, none, none, none, some, none, none, some, some});
  for (const Camera& camera : smallCameras()) {
    ResolvedScene scene = plainScene(transfer, camera, 0.5);
    // The gradient is known at voxels alone, and bends between them.
    checkOnCpu(grid, scene, 2e-3, 2e-2);
  }
}

// All are the same rays through the same voxels: only the order of sums over planes of bricks could differ.
TEST_CASE("Bricks and culling change nothing of a picture of the CPU", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid = makeDense(glm::ivec3(40, 37, 33), {-7, 3, 100});
  std::mt19937 random(9);
  for (int trial = 0; trial < 4; ++trial) {
    Camera base;
    base.width = base.height = 40;
    base.projection = trial % 2 ? Projection::orthographic : Projection::perspective;
    ResolvedScene scene = plainScene(trial == 3 ? randomTransferFunction2d(random, 4).windowed(0.2, 0.8)
                                                : randomTransferFunction(random, 8).windowed(0.1, 0.9),
                                     orbitCamera(grid.worldBounds(), 1.1 * trial, 0.3, base), 0.5);
    const Image picture = renderedOnCpu(technique, grid, scene).colour;
    INFO("trial " << trial);
    REQUIRE(largestAlpha(picture) > 0.1);
    for (const int interior : {8, 24, 64}) {
      ResolvedScene other = scene;
      other.bricks.interior = interior;
      CHECK(maxDifference(renderedOnCpu(technique, grid, other).colour, picture) < 2e-5);
    }
    ResolvedScene all = scene;
    all.bricks.culling = false;
    CHECK(maxDifference(renderedOnCpu(technique, grid, all).colour, picture) < 2e-5);
    ResolvedScene whole = scene;
    whole.bricks.bricked = false;
    CHECK(maxDifference(renderedOnCpu(technique, grid, whole).colour, picture) < 2e-5);
  }
}

TEST_CASE("Voxels of 8 and 16 bits and floats of 16 and 32 give one picture on the CPU", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const auto value = [](const glm::ivec3& i) { return std::round(200 * smallBlobs(i)); };
  const TransferFunction transfer({{20, {kAlbedo, 0}}, {200, {kAlbedo, 0.5}}});
  const Camera camera = smallCameras()[1];
  const auto pictureOf = [&](double scale, double offset) {
    const ScalarGrid grid = makeFilled(
        glm::ivec3(24), {0, 0, 0}, [&](const glm::ivec3& i) { return value(i) * scale + offset; },
        static_cast<float>(offset));
    std::vector<TransferFunction::Point> points;
    for (std::size_t i = 0; i < 2; ++i) points.push_back({transfer.values()[i] * scale + offset, transfer.media()[i]});
    return renderedOnCpu(technique, grid, plainScene(TransferFunction(points), camera, 0.5)).colour;
  };
  const Image bytes = pictureOf(1, 0);
  REQUIRE(largestAlpha(bytes) > 0.5);
  // Steps of the table lie elsewhere between the voxels' values: half a step of 4087 in the 180 units of the function.
  CHECK(maxDifference(pictureOf(17, 1000), bytes) < 5e-4);
  CHECK(maxDifference(pictureOf(0.123, -5), bytes) < 5e-4);
  // Halves of whole numbers are 16-bit floats.
  CHECK(maxDifference(pictureOf(0.5, -8), bytes) < 5e-4);
}

TEST_CASE("All sets of instructions give one picture", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid = withTransform(makeDense(glm::ivec3(30)), crookedTransform());
  Camera base;
  base.width = base.height = 48;
  const ResolvedScene scene = plainScene(TransferFunction({{0.3, {kAlbedo, 0}}, {0.8, {{0.2, 0.4, 1}, 0.4}}}),
                                         orbitCamera(grid.worldBounds(), 0.8, 0.5, base), 0.5);
  const Image best = renderedOnCpu(technique, grid, scene).colour;
  REQUIRE(largestAlpha(best) > 0.3);
  useBaselineInstructions(true);
  const Image least = renderedOnCpu(technique, grid, scene).colour;
  useBaselineInstructions(false);
  // Values round to the next step of the table where they lie half-way between two.
  CHECK(maxDifference(best, least) < 5e-5);
}

TEST_CASE("Visibility and depth of a picture of the CPU are those of the reference", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid = blobGrid();
  for (const Camera& camera : smallCameras()) {
    const ResolvedScene scene = blobScene(camera, 1.5);
    const ReferencePicture exact = renderReference(grid, scene);
    const Picture picture = technique == Technique::rays
                                ? byRays(grid, scene, kLayers)
                                : shearWarped(grid, scene, kLayers, ShearWarpSampling{2, 3, 1});
    int compared = 0;
    for (std::size_t i = 0; i < picture.depth.pixels.size(); ++i) {
      if (exact.colour.pixels[4 * i + 3] < 0.3f) continue;
      ++compared;
      CHECK(std::abs(picture.depth.pixels[i] - exact.depth.pixels[i]) < 0.25);
      CHECK(picture.visibility.pixels[i] == Approx(picture.opacity.pixels[i]).margin(2e-2));
    }
    CHECK(compared > 60);
  }
}

// Between two main axes slices and rays are others. The picture may jump by no more than both are off.
TEST_CASE("A turning camera changes the picture little where the main axis changes", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid = blobGrid();
  Camera base;
  base.width = base.height = 64;
  for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
    base.projection = projection;
    const auto at = [&](double azimuth) {
      return plainScene(ramp(0.6), orbitCamera(grid.worldBounds(), azimuth, 0.1, base), 0.5);
    };
    double across = 0, beside = 0, error = 0;
    Image before;
    for (int i = -4; i <= 4; ++i) {
      const ResolvedScene scene = at(std::numbers::pi / 4 + 1e-4 * (i + 0.5));
      const Image picture = renderedOnCpu(technique, grid, scene).colour;
      if (i == 0) error = rmsDifference(picture, renderReference(grid, scene).colour);
      if (i > -4) (i == 0 ? across : beside) = std::max(i == 0 ? across : beside, rmsDifference(picture, before));
      before = picture;
    }
    INFO("where the axis changes " << across << ", elsewhere " << beside << ", error " << error);
    CHECK(across < 2 * error + beside);
    CHECK(across < 2e-3);
    CHECK(beside < 1e-3);
  }
}

TEST_CASE("What techniques on the CPU cannot render is refused in one line", "[sweep][cpu]") {
  const Technique technique = GENERATE(Technique::rays, Technique::shearWarp);
  INFO(techniqueName(technique));
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = blobScene(smallCameras()[0]);
  scene.model = Model::cone;
  scene.method = Method::ordinates;
  const std::string name = techniqueName(technique);
  CHECK_THROWS_WITH(renderedOnCpu(technique, grid, scene),
                    "method: ordinates is one of slices; " + name + " takes light from a light volume");
  scene.model = Model::coneRay;
  CHECK_THROWS_WITH(renderedOnCpu(technique, grid, scene), "model: cone-ray is integrated by the reference alone; " +
                                                               name + " renders emission, cone, ambient and lights");
  scene.model = Model::emission;
  scene.bricks.budgetMiB = 0;
  CHECK_THROWS_WITH(renderedOnCpu(technique, grid, scene),
                    Catch::Contains("bricks.budgetMiB: the voxels of one brick take "));
}
