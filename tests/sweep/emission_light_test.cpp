// What a second grid emits lights the medium around it: closed forms, the reference, and what must not change it.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <glm/geometric.hpp>

#include "support/closed_forms.h"
#include "support/fire_scene.h"
#include "sweep/picture_of_grid.h"
#include "umbrick/light/light_volume.h"

using namespace umbrick;

namespace {

constexpr double kRadius = 6, kRadiance = 0.25;
const glm::dvec3 kCentre(30, 29, 31), kTint(1, 0.5, 0.1);

ScalarGrid ballGrid(double radius) {
  return fieldGrid({glm::ivec3(0), glm::ivec3(63)},
                   [=](const glm::dvec3& p) { return glm::clamp(radius + 0.5 - glm::distance(p, kCentre), 0.0, 1.0); });
}

// A ball that burns in smoke so thin that nothing is lost on the way.
ScalarGrid ballOfFire() { return withEmission(ballGrid(29), ballGrid(kRadius)); }

TransferFunction upTo(double brightest) { return TransferFunction({{0, {kTint, 0}}, {1, {kTint, brightest}}}); }

ResolvedScene litByFire(const TransferFunction& medium, const TransferFunction& fire, const Camera& camera,
                        double radiance = 0) {
  ResolvedScene scene = fireScene(medium, fire, camera, 0.5);
  scene.model = Model::ambient;
  scene.method = Method::lightVolume;
  scene.ambient = glm::dvec3(radiance);
  scene.occlusion.ordinates.directions = 16;
  return scene;
}

// Smoke and fire that overlap in part.
ScalarGrid smokeWithFire() { return withEmission(makeSparse({0, 0, 0}, 1, 8, 40), makeSparse({3, -2, 5}, 2, 8, 40)); }
Camera towardsFire() { return perspectiveCamera({53, -30, 50}, {20, 20, 22}, 0.8, 12); }

}  // namespace

TEST_CASE("A ball of fire lights thin smoke by its solid angle and what it shows of itself", "[sweep][emission]") {
  const ScalarGrid grid = ballOfFire();
  const ResolvedScene scene = litByFire(homogeneous(glm::dvec3(1), 1e-7), upTo(kRadiance), towardsFire());
  const auto bricks = cpuBricksFor(grid, scene);
  LightMedium medium{scene.transfer, {}, {}, {}};
  medium.emitted = scene.emitted;
  for (const Brick& brick : bricks->bricks) medium.cells.push_back(brick.origin);
  LightVolume light(*bricks);
  REQUIRE(light.update(medium, std::uint64_t{1} << 32));
  CHECK(light.coloured());
  CHECK(light.stats().glowCell == 1);  // of 64^3 voxels
  const glm::ivec3 edge = bricks->layout.edge();
  std::vector<float> shares(bricks->layout.voxels() * 3);
  int seen = 0;
  struct {
    double mean = 0, square = 0;
    int count = 0;
  } far;
  for (const Brick& brick : bricks->bricks) {
    light.read(brick.origin, shares);
    for (int i = 0; i < edge.x * edge.y * edge.z; i += 7) {
      const glm::ivec3 at(i % edge.x, i / edge.x % edge.y, i / (edge.x * edge.y));
      const double r = glm::distance(glm::dvec3(brick.origin + at - bricks->layout.apron), kCentre);
      const float* const share = shares.data() + 3 * static_cast<std::size_t>(i);
      if (share[0] == 0 || r > 26) continue;
      // The mean over all directions of the length within the ball: R inside at the centre; outside a known integral.
      const double x = r / kRadius,
                   rest = std::abs(x - 1) > 1e-6 ? (1 - x * x) * std::log(std::abs((x + 1) / (x - 1))) : 0;
      const double mean = x < 1e-3 ? kRadius : kRadius / 2 * (1 + rest / (2 * x));
      const double expected = kRadiance * mean;
      const double off = share[0] * light.whole().r / expected - 1;
      INFO(r << " voxels from the centre: " << share[0] * light.whole().r << " of " << expected);
      if (r < 9) {
        CHECK(std::abs(off) < 0.06);  // whatever cell the ball's edge crosses, and the directions that meet it
      } else {
        far.mean += off;
        far.square += off * off;
        ++far.count;
      }
      CHECK(share[1] * light.whole().g == Approx(share[0] * light.whole().r * kTint.g).epsilon(0.01).margin(1e-3));
      ++seen;
    }
  }
  CHECK(seen > 1000);
  // From far off few of the directions meet the ball, here more and there less of it.
  const double rms = std::sqrt(far.square / far.count);
  INFO("far off: mean " << far.mean / far.count << ", rms " << rms);
  CHECK(std::abs(far.mean / far.count) < 0.03);
  CHECK(rms < 0.2);
}

TEST_CASE("Smoke that fire lights is that of the reference, with other light and without", "[sweep][emission]") {
  const ScalarGrid grid = smokeWithFire();
  for (const double ambient : {0.0, 0.4}) {
    const ResolvedScene scene = litByFire(ramp(0.4), upTo(0.3), towardsFire(), ambient);
    ResolvedScene unlit = scene;
    unlit.emission.lightsMedium = false;
    ReferenceOptions options;
    options.directions = 64;
    options.tolerance = 0.01;
    const Image exact = renderReference(grid, scene, options).colour,
                less = renderReference(grid, unlit, options).colour;
    const Image picture = byRays(grid, scene, {}, 2).colour, dark = byRays(grid, unlit, {}, 2).colour;
    const double bounce = rmsDifference(exact, less), off = rmsDifference(picture, exact);
    INFO("ambient " << ambient << ": the bounce is " << bounce << ", off by " << off << ", without it by "
                    << rmsDifference(dark, less));
    CHECK(bounce > 0.02);
    CHECK(off < 0.1 * bounce + rmsDifference(dark, less));
  }
}

TEST_CASE("Light that is emitted is the same however the volume is cut, and each time", "[sweep][emission]") {
  const ScalarGrid grid = smokeWithFire();
  ResolvedScene scene = litByFire(ramp(0.4), upTo(0.3), towardsFire(), 0.2);
  scene.bricks.bricked = false;
  const Image whole = byRays(grid, scene).colour;
  scene.bricks.bricked = true;
  for (const int interior : {8, 24}) {
    scene.bricks.interior = interior;
    const Image picture = byRays(grid, scene).colour;
    CHECK(maxDifference(whole, picture) < 2e-4);  // half a code of 16 bits for each of some ten samples that count
    CHECK(picture.pixels == byRays(grid, scene).colour.pixels);
  }
}

TEST_CASE("A clip plane that takes the fire away takes its light, too", "[sweep][emission]") {
  const ScalarGrid grid = ballOfFire();
  const Camera camera = perspectiveCamera({90, 29, 31}, kCentre, 0.8, 12);
  ResolvedScene scene = litByFire(homogeneous(glm::dvec3(1), 0.01), upTo(kRadiance), camera);
  const Image lit = byRays(grid, scene).colour;
  scene.clipPlanes = {{1, 0, 0, -(kCentre.x + kRadius + 2)}};  // what is left lies to the right of the fire
  const Image dark = byRays(grid, scene).colour;
  CHECK(*std::ranges::max_element(lit.pixels) > 0.1f);
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 12; ++x)
      for (int c = 0; c < 3; ++c) CHECK(dark.at(x, y)[c] < 1e-3f);
}

TEST_CASE("Fire lights nothing where it is asked not to, and in Phong's model", "[sweep][emission]") {
  const ScalarGrid grid = smokeWithFire();
  ResolvedScene scene = litByFire(ramp(0.4), upTo(0.3), towardsFire(), 0.2);
  CHECK(emissionLights(scene));
  ResolvedScene phong = scene, unlit = scene;
  phong.shading.kind = Shading::phong;
  CHECK_FALSE(emissionLights(phong));
  unlit.model = Model::emission;
  CHECK_FALSE(emissionLights(unlit));
  unlit = scene;
  unlit.emission.lightsMedium = false;
  CHECK_FALSE(emissionLights(unlit));
  CHECK(maxDifference(byRays(grid, scene).colour, byRays(grid, unlit).colour) > 0.02);
}
