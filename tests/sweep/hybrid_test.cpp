// The mode hybrid by rays on the CPU: against closed forms, the mode integrate and the reference.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "support/hybrid_scenes.h"
#include "support/observed_order.h"
#include "sweep/value_picture.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Contains;

namespace {

constexpr double kNoise = 1e-4;  // values of 16 bits, and light in the table of the medium

}  // namespace

TEST_CASE("The medium behind the first surface is seen with what that lets through", "[sweep][cpu][modes]") {
  const ScalarGrid grid = fallingGrid();
  for (const double opacity : {0.0, 0.35, 1.0}) {
    ResolvedScene scene = fallingScene(opacity);
    // From z = 14, where the red surface is, to the clip box at 1; the medium before it and the green surface are not
    // seen.
    const double behind = 1 - std::exp(-kDense * 13), through = 1 - opacity;
    const Picture picture = valuePicture(grid, scene, {}, true);
    const float* const pixel = picture.colour.at(1, 2);
    CHECK(pixel[0] == Approx(opacity + through * behind * kBlue.r).margin(kNoise));
    CHECK(pixel[1] == Approx(through * behind * kBlue.g).margin(kNoise));
    CHECK(pixel[2] == Approx(through * behind * kBlue.b).margin(kNoise));
    CHECK(pixel[3] == Approx(opacity + through * behind).margin(kNoise));
    // Layers are those of the surface, depth and V those of both: the mean depth of a medium is its own integral.
    CHECK(layerOf(picture, "value").at(1, 2)[0] == Approx(0.3));
    CHECK(layerOf(picture, "position").at(1, 2)[2] == Approx(14).margin(1e-4));
    CHECK(layerOf(picture, "normal").at(1, 2)[2] == Approx(1));
    const double tau = kDense * 13, sum = (1 - (1 + tau) * std::exp(-tau)) / kDense;
    const double depth = (opacity * 46 + through * (46 * behind + sum)) / (opacity + through * behind);
    CHECK(*picture.depth.at(1, 2) == Approx(depth).margin(5e-3));
    CHECK(*picture.visibility.at(1, 2) == Approx(opacity + through * behind).margin(kNoise));
    // From the other side the green surface is the first one.
    scene.camera.eye.z = -40;
    const double beyond = 1 - std::exp(-kDense * 10);
    const Image other = valuePicture(grid, scene).colour;
    CHECK(other.at(1, 2)[0] == Approx(0.75 * beyond * kBlue.r).margin(kNoise));
    CHECK(other.at(1, 2)[1] == Approx(0.25 + 0.75 * beyond * kBlue.g).margin(kNoise));
    CHECK(other.at(1, 2)[3] == Approx(0.25 + 0.75 * beyond).margin(kNoise));
  }
}

TEST_CASE("A ray that meets no surface shows nothing, and a background lies behind all", "[sweep][cpu][modes]") {
  ResolvedScene scene = fallingScene(0.35);
  const ScalarGrid grid = fallingGrid();
  scene.clipBox = Box{{0, 0, 15}, {19, 19, 18}};  // before both surfaces
  CHECK(largestAlpha(valuePicture(grid, scene).colour) == 0);
  CHECK(largestAlpha(renderReference(grid, scene).colour) == 0);
  const glm::dvec3 background(0.3, 0.1, 0.7);
  scene.background = background;
  CHECK(valuePicture(grid, scene).colour.at(1, 1)[2] == Approx(background.b));
  scene.clipBox = fallingScene(0.35).clipBox;
  const double past = (1 - 0.35) * std::exp(-kDense * 13);
  CHECK(valuePicture(grid, scene).colour.at(1, 1)[0] ==
        Approx(0.35 + (1 - 0.35) * (1 - std::exp(-kDense * 13)) * kBlue.r + past * background.r).margin(kNoise));
}

// Where a clear surface lies before all of the medium, what is behind it is all of it.
TEST_CASE("Behind a clear surface around it a medium is the one of integrate, however it is lit",
          "[sweep][cpu][modes]") {
  const ScalarGrid grid = blobGrid();
  for (const Camera& camera : smallCameras())
    for (int light = 0; light < 3; ++light) {
      ResolvedScene scene = hybridScene(nothingBelow(0.3), camera, {surfaceAt(0.25, 0)});
      if (light == 1) {
        scene.model = Model::cone;
        scene.method = Method::lightVolume;
      }
      if (light == 2) scene.shading.kind = Shading::phong;
      const Picture hybrid = valuePicture(grid, scene, {}, true);
      scene.mode = Mode::integrate;
      const Picture whole = valuePicture(grid, scene, {}, true);
      CHECK(largestAlpha(whole.colour) > 0.5);
      // A segment that the surface cuts is integrated from there, where it is clear up to the medium.
      CHECK(maxDifference(hybrid.colour, whole.colour) < 2e-5);
      CHECK(maxDifference(hybrid.visibility, whole.visibility) < 2e-5);
    }
}

TEST_CASE("Surfaces with a medium behind them are those of the reference", "[sweep][cpu][modes]") {
  const ScalarGrid grid = withTransform(makeFilled(glm::ivec3(24), glm::ivec3(0), smallBlobs), crookedTransform());
  Camera base;
  base.width = base.height = 32;
  for (const Projection projection : {Projection::orthographic, Projection::perspective})
    for (const Shading shading : {Shading::automatic, Shading::phong, Shading::none}) {
      base.projection = projection;
      ResolvedScene scene = hybridScene(nothingBelow(0.05), orbitCamera(grid.worldBounds(), 1.7, 0.4, base),
                                        {surfaceAt(0.5, 0.4), surfaceAt(0.2, 0.3)});
      scene.shading.kind = shading;
      INFO("perspective " << (projection == Projection::perspective) << ", shading " << static_cast<int>(shading));
      const ReferencePicture exact = renderReference(grid, scene);
      const Picture seen = valuePicture(grid, scene, 8, true);
      CHECK(largestAlpha(exact.colour) > 0.5);
      CHECK(rmsDifference(seen.colour, exact.colour) < 1e-3);
      CHECK(rmsDifference(seen.visibility, exact.visibility) < 1e-3);
      for (std::size_t i = 0; i < seen.depth.pixels.size(); ++i)
        CHECK(std::isinf(seen.depth.pixels[i]) == std::isinf(exact.depth.pixels[i]));
    }
}

TEST_CASE("A flight through a colon shows the wall and what is behind it", "[sweep][cpu][modes]") {
  const ScalarGrid grid = colonGrid();
  for (const double fov : {60.0, 150.0}) {
    ResolvedScene scene = hybridScene(colonTransfer(), colonCamera(fov * kDegree, 40), {surfaceAt(0.5, 0.6)});
    CAPTURE(fov);
    const Image seen = valuePicture(grid, scene, 8).colour, exact = renderReference(grid, scene).colour;
    CHECK(rmsDifference(seen, exact) < 1e-3);
    double least = 1;
    for (std::size_t i = 3; i < seen.pixels.size(); i += 4) least = std::min<double>(least, seen.pixels[i]);
    CHECK(least > 0.6);  // the tube is closed, so that each ray meets its wall
    // Pixels of several rays are the mean over them, of both.
    scene.sampling.pixelSamples = 3;
    CHECK(rmsDifference(valuePicture(grid, scene, 8).colour, renderReference(grid, scene).colour) < 1e-3);
  }
}

TEST_CASE("Bricks that are skipped, cut and read in bands change no hybrid", "[sweep][cpu][modes]") {
  const ScalarGrid grid = makeSparse(glm::ivec3(-5, 7, 2), 3, 12, 90);
  const glm::dvec3 centre = grid.worldBounds().centre();
  ResolvedScene scene = hybridScene(
      nothingBelow(0.1), perspectiveCamera(centre + glm::dvec3(70, 90, 120), centre, 0.7, 60), {surfaceAt(0.3, 0.5)});
  const Image skipped = valuePicture(grid, scene).colour;
  CHECK(largestAlpha(skipped) > 0.5);
  scene.bricks.culling = false;
  CHECK(maxDifference(valuePicture(grid, scene).colour, skipped) < 1e-6);
  scene.bricks.bricked = false;
  CHECK(maxDifference(valuePicture(grid, scene).colour, skipped) < 1e-5);
}

TEST_CASE("A renderer comes to hybrid and leaves it", "[sweep][cpu][modes]") {
  const ScalarGrid grid = blobGrid();
  const ResolvedScene hybrid = hybridScene(nothingBelow(0.1), smallCameras()[1], {surfaceAt(0.3, 0.5)});
  ResolvedScene surface = hybrid, medium = hybrid, other = hybrid;
  surface.mode = Mode::isosurface;
  medium.mode = Mode::integrate;
  other.surfaces = {surfaceAt(0.6, 0.5)};
  const auto bricks = valueBricks(grid, hybrid);
  RayRenderer renderer(*bricks, hybrid);
  for (const ResolvedScene& scene : {hybrid, surface, hybrid, medium, other, hybrid}) {
    renderer.setScene(scene);
    CHECK(maxDifference(renderer.render().colour, RayRenderer(*bricks, scene).render().colour) == 0);
  }
  // One that is refused for its medium, whose surfaces are no trouble, changes nothing.
  ResolvedScene refused = other;
  refused.model = Model::cone;
  CHECK_THROWS(renderer.setScene(refused));
  CHECK(maxDifference(renderer.render().colour, RayRenderer(*bricks, hybrid).render().colour) == 0);
}

TEST_CASE("What hybrid cannot do is refused in one line", "[sweep][cpu][modes]") {
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = hybridScene(nothingBelow(0.1), smallCameras()[1], {});
  CHECK_THROWS_WITH(valuePicture(grid, scene), Contains("must be one value or more for the mode hybrid"));
  CHECK_THROWS_WITH(renderReference(grid, scene), Contains("must be one value or more for the mode hybrid"));
  scene.surfaces = {surfaceAt(0.3)};
  ReferenceOptions random;
  random.integrator = Integrator::monteCarlo;
  CHECK_THROWS_WITH(renderReference(grid, scene, random), Contains("mode: hybrid is integrated by quadrature"));
  scene.model = Model::cone;
  CHECK_THROWS_WITH(valuePicture(grid, scene), Contains("method: dos is one of slices"));
}
