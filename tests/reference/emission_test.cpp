// Light that a second grid emits, by the reference: against closed forms.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "reference/reference_fixture.h"
#include "support/complaint.h"
#include "support/fire_scene.h"
#include "umbrick/core/error.h"

using namespace umbrick;

namespace {

const glm::dvec3 kLight(3, 1, 0.25), kSmoke(0.8, 0.7, 0.6);
const IndexBox kBox{glm::ivec3(-2, -2, 0), glm::ivec3(26, 26, 24)};
constexpr double kLow = 5.3, kHigh = 8.6;  // a slab in z

ScalarGrid heightGrid(const glm::dmat4& transform = glm::dmat4(1), float background = -1) {
  return fieldGrid(
      kBox, [](const glm::dvec3& p) { return p.z; }, transform, background);
}

// Rays through the middle of the slab, to which nothing but the slab's two faces matters.
Camera fromAbove(double tilt) { return orthographicCamera({12 + 30 * tilt, 12, 36}, {12, 12, 6}, 4, 5); }

double stretchOf(const Camera& camera) {
  const ViewRay ray = viewRay(camera, 2.5, 2.5);
  return ray.stretch() / std::abs(ray.direction.z);
}

TransferFunction slab(double sigma_t) {
  return TransferFunction(
      {{kLow, {kSmoke, 0}}, {kLow, {kSmoke, sigma_t}}, {kHigh, {kSmoke, sigma_t}}, {kHigh, {kSmoke, 0}}});
}

// A slab burns in air that is cut off above it, where values fall back to the background, through those of the slab.
ResolvedScene slabScene(const TransferFunction& transfer, const Camera& camera, double ambient = 0) {
  ResolvedScene scene = fireScene(transfer, glowing(kLight, kLow, kHigh), camera, 0.5, ambient);
  scene.clipPlanes = {{0, 0, -1, 20}};
  return scene;
}

// The largest difference from one colour, relative to it.
double worstOf(const Image& image, const glm::dvec3& expected) {
  double worst = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(image.at(x, y)[c] - expected[c]) / std::max(expected[c], 1e-30));
  return worst;
}

}  // namespace

TEST_CASE("A slab that emits and lets all light through has its radiance times its thickness",
          "[reference][emission]") {
  const ScalarGrid grid = withEmission(makeVoxels({{{12, 12, 12}, 1.0f}}), heightGrid());
  for (const double tilt : {0.0, 0.4}) {
    const Camera camera = fromAbove(tilt);
    const Image picture = renderReference(grid, slabScene(clearAir(), camera)).colour;
    CHECK(worstOf(picture, kLight * (kHigh - kLow) * stretchOf(camera)) < 4 * kFloatRounding);
    CHECK(picture.at(2, 2)[3] == 0);
  }
}

TEST_CASE("A slab that emits and absorbs has L / sigma (1 - exp(-sigma d)), thin and thick", "[reference][emission]") {
  const ScalarGrid grid = withEmission(heightGrid(), heightGrid());
  for (const double tilt : {0.0, 0.4})
    for (const double sigma_t : {1e-6, 0.05, 0.4, 3.0, 200.0})
      for (const double ambient : {0.0, 0.5}) {
        const Camera camera = fromAbove(tilt);
        const double d = (kHigh - kLow) * stretchOf(camera), alpha = -std::expm1(-sigma_t * d);
        INFO("sigma_t " << sigma_t << ", thickness " << d);
        const Image picture = renderReference(grid, slabScene(slab(sigma_t), camera, ambient)).colour;
        // Where it is as good as opaque the ray ends: 1e-6 of the light is behind that.
        CHECK(worstOf(picture, kLight / sigma_t * alpha + ambient * alpha * kSmoke) < 4 * kFloatRounding + 2e-6);
        CHECK(std::abs(picture.at(2, 2)[3] - alpha) < 2e-6);
      }
}

TEST_CASE("What emits behind a slab is dimmed by it, and a background behind both", "[reference][emission]") {
  const ScalarGrid grid = withEmission(heightGrid(), heightGrid());
  ResolvedScene scene = slabScene(
      TransferFunction({{13.1, {kSmoke, 0}}, {13.1, {kSmoke, 0.15}}, {17.45, {kSmoke, 0.15}}, {17.45, {kSmoke, 0}}}),
      fromAbove(0.4));
  scene.background = glm::dvec3(0.3, 0.2, 0.1);
  const double stretch = stretchOf(scene.camera), through = std::exp(-0.15 * 4.35 * stretch);
  CHECK(worstOf(renderReference(grid, scene).colour,
                through * (kLight * (kHigh - kLow) * stretch + *scene.background)) < 4 * kFloatRounding);
}

TEST_CASE("A ball that fades from its middle has the integral of each chord, within what interpolation adds",
          "[reference][emission]") {
  // Values are r^2, of which trilinear interpolation is too large by up to 1/4 for each axis; the emission is
  // 1 - r^2 / R^2, whose integral over a chord of half-length h is 4/3 h^3 / R^2.
  constexpr double kRadius = 9;
  const glm::dvec3 middle(12.3, 11.8, 12.1);
  const ScalarGrid ball = fieldGrid(
      {glm::ivec3(0), glm::ivec3(25)}, [&](const glm::dvec3& p) { return glm::dot(p - middle, p - middle); },
      glm::dmat4(1), 1000);
  const TransferFunction emitted({{0, {glm::dvec3(1), 2}}, {kRadius * kRadius, {glm::dvec3(1), 0}}});
  const Camera camera = orthographicCamera(middle + glm::dvec3(20, -30, 25), middle, 17, 12);
  const Image picture =
      renderReference(withEmission(makeVoxels({{{12, 12, 12}, 1.0f}}), ball), fireScene(clearAir(), emitted, camera))
          .colour;
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 12; ++x) {
      const ViewRay ray = viewRay(camera, x + 0.5, y + 0.5);
      const glm::dvec3 to = middle - ray.origin, direction = glm::normalize(ray.direction);
      const double across = glm::length(to - glm::dot(to, direction) * direction);
      const double half = std::sqrt(std::max(0.0, kRadius * kRadius - across * across));
      const double exact = 2 * 4.0 / 3 * half * half * half / (kRadius * kRadius);
      const float found = picture.at(x, y)[0];
      INFO("pixel " << x << ", " << y << ": " << found << " of " << exact);
      CHECK(found <= exact * (1 + 1e-5) + 1e-6);
      CHECK(found >= exact - 2 * 2 * half * 0.75 / (kRadius * kRadius));
    }
}

TEST_CASE("Emission in empty space, in tiles and without skipping is the same", "[reference][emission]") {
  const ScalarGrid fire = makeSparse({-30, 4, 7}, 3, 5, 60);
  const Camera camera = perspectiveCamera({60, -70, 90}, {0, 34, 37}, 0.7, 16);
  const ResolvedScene scene = fireScene(
      solidAbove(kSmoke, 0.3), TransferFunction({{0.1, {{1, 0.6, 0.2}, 0}}, {1, {{1, 0.6, 0.2}, 0.4}}}), camera);
  const ScalarGrid smoke = makeTiles(-1);  // tiles of several sizes, and nothing at -1
  const ScalarGrid both = withEmission(smoke, fire);
  ReferenceOptions all;
  all.skipEmpty = false;
  const Image picture = renderReference(both, scene).colour;
  float brightest = 0;
  for (const float number : picture.pixels) brightest = std::max(brightest, number);
  CHECK(brightest > 0.2f);                                                         // there is something to compare
  CHECK(maxDifference(picture, renderReference(both, scene, all).colour) < 1e-5);  // both end rays at 1e-6
}

// Differences of a random picture from an exact one, in its own standard errors.
struct Deviations {
  double rms = 0, largest = 0;
};
Deviations deviationsOf(const ReferencePicture& random, const Image& exact) {
  Deviations found;
  int count = 0;
  for (std::size_t i = 0; i < exact.pixels.size(); ++i) {
    const double error = random.standardError.pixels[i];
    if (i % 4 == 3 || !(error > 1e-6)) continue;
    const double one = std::abs(double{random.colour.pixels[i]} - double{exact.pixels[i]}) / error;
    found.rms += one * one;
    found.largest = std::max(found.largest, one);
    ++count;
  }
  found.rms = std::sqrt(found.rms / std::max(count, 1));
  return found;
}

TEST_CASE("Monte Carlo finds what quadrature does of a fire, and of the smoke that it lights",
          "[reference][emission]") {
  const ScalarGrid grid = withEmission(makeSparse({0, 0, 0}, 1, 6, 30), makeSparse({2, -2, 4}, 2, 6, 30));
  const Camera camera = perspectiveCamera({48, -34, 40}, {15, 15, 16}, 0.8, 12);
  ReferenceOptions random;
  random.integrator = Integrator::monteCarlo;
  random.samples = 3000;
  ResolvedScene scene =
      fireScene(TransferFunction({{0, {kSmoke, 0}}, {1, {kSmoke, 0.4}}}),
                TransferFunction({{0.2, {{1, 0.6, 0.2}, 0}}, {0.9, {{1, 0.8, 0.5}, 0.5}}}), camera, 0.5, 0.4);
  SECTION("unlit, before a background") { scene.background = glm::dvec3(0.2, 0.1, 0.4); }
  SECTION("one bounce, with other light") { scene.model = Model::ambient; }
  SECTION("one bounce alone") {
    scene.model = Model::ambient;
    scene.ambient = glm::dvec3(0);
    random.samples = 20000;  // of which few meet the fire twice: fewer would not know how much they differ
  }
  ReferenceOptions exactly;
  exactly.directions = 196;
  exactly.tolerance = 1e-3;
  const Image exact = renderReference(grid, scene, exactly).colour;
  const ReferencePicture found = renderReference(grid, scene, random);
  const Deviations off = deviationsOf(found, exact);
  INFO("rms " << off.rms << ", largest " << off.largest);
  // Of some 300 numbers of a normal distribution one is beyond 3.5 now and then; before a background the error is
  // stated from above, and 196 directions are off by a part of it.
  CHECK(off.rms > 0.3);
  CHECK(off.rms < 1.25);
  CHECK(off.largest < 4.5);
}

TEST_CASE("A missing grid and a background that glows are refused for emission", "[reference][emission]") {
  const ResolvedScene scene = slabScene(slab(1), fromAbove(0));
  CHECK(complaint<InvalidArgument>([&] { renderReference(heightGrid(), scene); }).find("'fire'") != std::string::npos);
  const ScalarGrid everywhere = withEmission(heightGrid(), heightGrid(glm::dmat4(1), 6));
  CHECK(complaint<InvalidArgument>([&] { renderReference(everywhere, scene); }).find("glow everywhere") !=
        std::string::npos);
}
