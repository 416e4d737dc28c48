// Hard cases of what voxels and the transfer function say: solid media, values that are not finite or hardly differ.
// Tested elsewhere: sigma_t d from 1e-8 to 1e4 (emission_gl_test), the formulas themselves (hard_formulas_gl_test,
// optics: medium_test), the one line that the programs say of NaN and Inf (tools: hard_volumes_test).
// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <string>

#include "shade/hard_case.h"
#include "umbrick/grid/float_grid.h"

using namespace umbrick;

namespace {

TransferFunction rampBetween(double low, double high, double sigma_t) {
  return TransferFunction({{low, {{0.8, 0.4, 0.1}, 0}}, {high, {{0.8, 0.4, 0.1}, sigma_t}}});
}

// Returns a ball of value `inside` in `outside`, with nothing between them but what interpolation makes.
FieldBricks::Field ball(double inside, double outside) {
  return [=](const glm::ivec3& i) { return glm::length(glm::dvec3(i) - glm::dvec3(15.5)) < 8 ? inside : outside; };
}

std::vector<Camera> ballCameras() {
  return {orthographicCamera({40, 30, 50}, {16, 16, 16}, 34, 40),
          perspectiveCamera({40, 30, 50}, {16, 16, 16}, 0.6, 40)};
}

}  // namespace

// The ball is what interpolation reaches: within a voxel of the ball's voxels all is opaque, beyond that nothing is.
TEST_CASE("Media as solid as numbers allow are opaque and empty space beside them stays empty", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const double sigma_t : {1e6, 1e30, 1e38, 1e300})
    for (const double background : {0.0, -1000.0})
      for (const Quadrature quadrature : {Quadrature::preintegrated, Quadrature::midpoint})
        for (const Camera& camera : ballCameras()) {
          INFO("sigma_t " << sigma_t << ", background " << background << ", midpoint "
                          << (quadrature == Quadrature::midpoint) << ", perspective "
                          << (camera.projection == Projection::perspective));
          ResolvedScene scene = plainScene(rampBetween(background, background + 1000, sigma_t), camera, 0.5);
          scene.sampling.quadrature = quadrature;
          FieldOptions options;
          options.background = static_cast<float>(background);
          const FieldBricks volume = fieldFor(scene, ball(background + 1000, background), kBlock, options);
          for (const Model model : {Model::emission, Model::cone}) {
            scene.model = model;
            const Picture picture = renderPicture(*context, volume, scene, {.visibilityAndDepth = true});
            const Image& image = picture.colour;
            CHECK(allWithin(image, 0, 1));
            double worst = 0;
            int inside = 0, outside = 0;
            for (int y = 0; y < image.height; ++y)
              for (int x = 0; x < image.width; ++x) {
                const ViewRay ray = viewRay(camera, x + 0.5, y + 0.5);
                const glm::dvec3 direction = glm::normalize(ray.direction);
                const glm::dvec3 middle = glm::dvec3(15.5) - ray.origin;
                const double distance = glm::length(middle - direction * glm::dot(middle, direction));
                const float* pixel = image.at(x, y);
                // The voxels nearest to the surface are at a distance of 7 to 8 from the middle.
                if (distance < 6.5) {
                  ++inside;
                  worst = std::max(worst, std::abs(1.0 - pixel[3]));
                  // The first slab in the medium is lit in full: nothing is behind what it hides.
                  if (model == Model::emission) worst = std::max(worst, std::abs(0.8 - pixel[0]));
                }
                if (distance > 10) {
                  ++outside;
                  worst = std::max(worst, static_cast<double>(pixel[3]));
                }
              }
            CHECK(inside > 100);
            CHECK(outside > 100);
            CHECK(worst < 1e-6);
          }
        }
}

// The background alone is transparent: no rounding may take it for a medium, whatever its place among the values
// and the texels.
TEST_CASE("Empty space beside a solid medium is exactly empty in any texels", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const double background : {-1000.0, 3.75, 1e6})
    for (const double below : {0.0, 350.0, 1500.0})
      for (const Quadrature quadrature : {Quadrature::preintegrated, Quadrature::midpoint})
        for (const std::string format : {"float32", "half", "unorm16", "unorm8"}) {
          if (format == "half" && background == 1e6) continue;  // beyond the range of half-floats
          INFO("background " << background << ", below " << below << ", midpoint "
                             << (quadrature == Quadrature::midpoint) << ", " << format);
          ResolvedScene scene = plainScene(rampBetween(background, background + 1000, 1e30), ballCameras()[0], 2);
          scene.camera.width = scene.camera.height = 12;
          scene.sampling.quadrature = quadrature;
          scene.bricks.format = format;
          FieldOptions options;
          options.background = static_cast<float>(background);
          const auto field = [&](const glm::ivec3& i) {
            if (glm::length(glm::dvec3(i) - glm::dvec3(16)) < 4) return background + 1000;
            return i == glm::ivec3(1) ? background - below : background;
          };
          const FieldBricks volume = fieldFor(scene, field, kBlock, options);
          const Image image = renderPicture(*context, volume, scene).colour;
          for (const int pixel : {0, 1, 10, 11}) CHECK(image.at(pixel, 6)[3] == 0);
          CHECK(largestAlpha(image) == 1);
        }
}

TEST_CASE("A clip plane through a solid medium shows its cut", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const double sigma_t : {1e30, 1e300}) {
    ResolvedScene scene = plainScene(rampBetween(0, 1, sigma_t), ballCameras()[0], 0.5);
    scene.clipPlanes = {{0.1, 0.2, -1, 14}};
    const FieldBricks volume = fieldFor(scene, ball(1, 0), kBlock);
    const Image image = renderPicture(*context, volume, scene).colour;
    CHECK(allWithin(image, 0, 1));
    CHECK(image.at(20, 20)[3] == Approx(1).epsilon(1e-6));
    CHECK(image.at(20, 20)[0] == Approx(0.8).epsilon(1e-6));
  }
}

// The grid with NaN and Inf is compared with the grid that has background in their place: they have the same bricks, so
// their pictures are the same, to the bit.
TEST_CASE("NaN and infinite voxels are background for renderer and reference", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  constexpr float kinds[] = {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity};
  const SmoothField smooth(1);
  const ScalarGrid clean = makeFilled(
      {20, 20, 20}, {0, 0, 0}, [&](const glm::ivec3& p) { return smooth(glm::dvec3(p)); }, 0.25f);
  const openvdb::FloatGrid::Ptr holed = clean.grid->deepCopy(), spoilt = clean.grid->deepCopy();
  TestRandom random(3);
  std::uint64_t bad = 0;
  for (int i = 0; i < 60; ++i) {
    const openvdb::Coord at(random.below(20), random.below(20), random.below(20));
    if (!std::isfinite(spoilt->tree().getValue(at))) continue;
    holed->tree().setValue(at, 0.25f);
    spoilt->tree().setValue(at, kinds[bad++ % 3]);
  }
  // One tile is not finite either, and another one is inactive, which nobody counts.
  holed->tree().addTile(1, openvdb::Coord(24, 0, 0), 0.25f, true);
  spoilt->tree().addTile(1, openvdb::Coord(24, 0, 0), infinity, true);
  holed->tree().addTile(1, openvdb::Coord(-32, 0, 0), 0.25f, false);
  spoilt->tree().addTile(1, openvdb::Coord(-32, 0, 0), infinity, false);
  for (const Model model : {Model::emission, Model::cone})
    for (const Camera& camera : ballCameras()) {
      ResolvedScene scene = plainScene(rampBetween(0.25, 1, 0.3), camera, 0.5);
      scene.model = model;
      scene.camera.width = scene.camera.height = 20;
      const auto bricks = bricksFor(makeGrid(spoilt), scene);
      CHECK(bricks->nonFiniteVoxels == bad + 512);
      const Image image = renderPicture(*context, *bricks, scene).colour;
      CHECK(largestAlpha(image) > 0.5);
      CHECK(allWithin(image, 0, 1));
      CHECK(maxDifference(image, renderGrid(*context, makeGrid(holed), scene).colour) == 0);
      ReferenceOptions quick;
      quick.directions = 16;
      const ReferencePicture exact = renderReference(makeGrid(spoilt), scene, quick);
      CHECK(exact.stats.nonFiniteVoxels == bad + 512);
      CHECK(maxDifference(exact.colour, renderReference(makeGrid(holed), scene, quick).colour) == 0);
      if (model == Model::emission) CHECK(rmsDifference(exact.colour, image) < 2e-3);
    }
}

// A driver may take denormal numbers for 0.
TEST_CASE("Denormal voxels are as good as 0 among others", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const auto waves = [](const glm::ivec3& i) {
    return 0.5 + 0.5 * std::sin(0.4 * i.x) * std::cos(0.3 * i.y + 0.2 * i.z);
  };
  const auto zeros = [&](const glm::ivec3& i) { return (i.x + i.y + i.z) % 3 ? waves(i) : 0.0; };
  const auto denormals = [&](const glm::ivec3& i) { return (i.x + i.y + i.z) % 3 ? waves(i) : 1e-40 * (i.x - 10); };
  for (const Quadrature quadrature : {Quadrature::preintegrated, Quadrature::midpoint}) {
    ResolvedScene scene = plainScene(rampBetween(0, 1, 0.3), ballCameras()[1], 0.5);
    scene.sampling.quadrature = quadrature;
    const Image image = renderPicture(*context, fieldFor(scene, zeros, kBlock), scene).colour;
    CHECK(largestAlpha(image) > 0.5);
    CHECK(maxDifference(image, renderPicture(*context, fieldFor(scene, denormals, kBlock), scene).colour) < 1e-6);
  }
}

// All values lie within what a float can hardly tell from 0, or from each other: the medium is that of the one value.
TEST_CASE("Volumes of next to one value show the medium of that value", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const double sigma_t = 0.05;
  for (const auto& [low, high] : {std::pair(0.0, 1e-40), std::pair(-1e-45, 1e-38), std::pair(0.0, 1e-30),
                                  std::pair(1e6, 1e6 + 0.0625), std::pair(-3e38, 3e38)})
    for (const Quadrature quadrature : {Quadrature::preintegrated, Quadrature::midpoint}) {
      INFO("values " << low << " to " << high << ", midpoint " << (quadrature == Quadrature::midpoint));
      ResolvedScene scene = plainScene(homogeneous({0.8, 0.4, 0.1}, sigma_t), ballCameras()[0], 0.5);
      scene.sampling.quadrature = quadrature;
      FieldOptions options;
      options.background = static_cast<float>(low);
      const FieldBricks volume = fieldFor(scene, ball(high, low), kBlock, options);
      const Image image = renderPicture(*context, volume, scene).colour;
      const std::vector<ClipPlane> planes = boxPlanes({glm::dvec3(kBlock.min), glm::dvec3(kBlock.max)});
      double worst = 0;
      for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
          const ViewRay ray = viewRay(scene.camera, x + 0.5, y + 0.5);
          const double alpha = -std::expm1(-sigma_t * keptDepths(ray, planes).length() * ray.stretch());
          worst = std::max(worst, !(std::abs(image.at(x, y)[3] - alpha) < 1) ? 1 : std::abs(image.at(x, y)[3] - alpha));
        }
      CHECK(worst < 2e-5);  // chords are known to 1e-4 units, see emission_gl_test
    }
}
