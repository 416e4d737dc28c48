// Transfer functions that are scaled by gradient magnitude.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "support/random_transfer.h"
#include "support/test_scenes.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Contains;

namespace {

Scene rampScene(const TransferFunction& transfer, const glm::dvec2& ramp) {
  Scene scene;
  scene.transfer = transfer;
  scene.orbit.reset();
  scene.gradientOpacity = ramp;
  return scene;
}

}  // namespace

TEST_CASE("Extinction is scaled by a ramp of the gradient, exactly, and colours are as they were", "[scene]") {
  std::mt19937 random(5);
  for (int i = 0; i < 100; ++i) {
    const TransferFunction given = randomTransferFunction(random, 6);
    const glm::dvec2 ramp(i % 3 == 0 ? 0.0 : uniform(random, 0, 4), uniform(random, 5, 20));
    const ResolvedScene scene = resolvedAnywhere(rampScene(given, ramp));
    REQUIRE(scene.transfer.is2d());
    double worst = 0;
    for (int k = 0; k < 50; ++k) {
      const double value = uniform(random, -10, 110), gradient = uniform(random, 0, 30);
      const Medium flat = given(value), scaled = scene.transfer(value, gradient);
      const double share = std::clamp((gradient - ramp.x) / (ramp.y - ramp.x), 0.0, 1.0);
      worst =
          std::max({worst, std::abs(scaled.sigma_t - share * flat.sigma_t), glm::length(scaled.albedo - flat.albedo)});
    }
    CHECK(worst < 1e-12);
    CHECK(scene.transfer.unit() == given.unit());
    // The scene is written with the function as it was given, and is the same once it is read.
    const Scene again = parseScene(printScene(scene), "again.json");
    CHECK(again.transfer == given);
    CHECK(again.gradientOpacity == ramp);
    CHECK(resolvedAnywhere(again) == scene);
  }
}

TEST_CASE("A scene whose function was changed after it was resolved is written as it is", "[scene]") {
  std::mt19937 random(6);
  ResolvedScene scene = resolvedAnywhere(rampScene(randomTransferFunction(random, 6), {1, 2}));
  for (const TransferFunction& other : {randomTransferFunction(random, 6), randomTransferFunction2d(random, 3)}) {
    scene.transfer = other;
    const Scene again = parseScene(printScene(scene), "again.json");
    CHECK(again.transfer == other);
    CHECK(again.gradientOpacity == glm::dvec2(0));
  }
}

TEST_CASE("Modes without a medium have no ramp", "[scene][modes]") {
  const TransferFunction given = homogeneous({1, 1, 1}, 2);
  Scene scene = rampScene(given, {1, 2});
  for (const Mode mode : {Mode::mip, Mode::average, Mode::isosurface}) {
    scene.mode = mode;
    CHECK(resolvedAnywhere(scene).transfer == given);
    CHECK(parseScene(printScene(resolvedAnywhere(scene)), "again.json").gradientOpacity == glm::dvec2(1, 2));
  }
  for (const Mode mode : {Mode::integrate, Mode::xray, Mode::hybrid}) {
    scene.mode = mode;
    CHECK(resolvedAnywhere(scene).transfer == withGradientOpacity(given, {1, 2}));
  }
}

TEST_CASE("A ramp that does not rise, is negative or has a 2D function beside it is refused", "[scene]") {
  std::mt19937 random(7);
  const TransferFunction given = homogeneous({1, 1, 1}, 2);
  CHECK_THROWS_WITH(validateScene(rampScene(given, {2, 1})),
                    "gradientOpacity: is (2 1), must be two numbers that ascend, or 0 0");
  CHECK_THROWS_WITH(validateScene(rampScene(given, {3, 3})), Contains("must be two numbers that ascend"));
  CHECK_THROWS_WITH(validateScene(rampScene(given, {-1, 3})),
                    "gradientOpacity: is (-1 3), must be two finite numbers of 0 or more");
  CHECK_THROWS_WITH(resolvedAnywhere(rampScene(randomTransferFunction2d(random, 3), {1, 2})),
                    Contains("gradientOpacity: is for transfer functions of the value alone"));
  Scene percent = rampScene(given, {10, 40});
  percent.gradientUnit = GradientUnit::percent;
  CHECK_THROWS_WITH(resolvedAnywhere(percent), Contains("gradientUnit: percent needs a volume"));
  CHECK_THROWS_WITH(parseScene(R"({"gradientOpacity": [2, 1]})", "s.json"),
                    "s.json:1:21: gradientOpacity: is (2 1), must be two numbers that ascend, or 0 0");
}
