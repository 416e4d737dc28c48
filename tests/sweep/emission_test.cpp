// Light that a second grid emits, by rays on the CPU: closed forms, the reference, and what must not change it.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include "support/closed_forms.h"
#include "support/complaint.h"
#include "support/fire_scene.h"
#include "sweep/picture_of_grid.h"
#include "umbrick/core/error.h"

using namespace umbrick;

namespace {

const glm::dvec3 kFire(3, 1, 0.25);
constexpr double kSlabLow = 5.3, kSlabHigh = 8.6;

ScalarGrid ascendingGrid() {
  return fieldGrid(
      {glm::ivec3(-2, -2, 0), glm::ivec3(26, 26, 24)}, [](const glm::dvec3& p) { return p.z; }, glm::dmat4(1), -1);
}

TransferFunction fading(double brightest) {
  return TransferFunction({{0.2, {{1, 0.6, 0.2}, 0}}, {0.9, {{1, 0.8, 0.5}, brightest}}});
}

// Smoke and fire that overlap in part, where the fire also burns in clear air.
ScalarGrid burningGrid() { return withEmission(makeSparse({0, 0, 0}, 1, 8, 40), makeSparse({3, -2, 5}, 2, 8, 40)); }

Camera onFire(bool perspective, int size = 24) {
  const glm::dvec3 centre(20, 20, 22), from(33, -50, 28);
  return perspective ? perspectiveCamera(centre + from, centre, 0.8, size)
                     : orthographicCamera(centre + from, centre, 60, size);
}

double rmsOfColours(const Image& a, const Image& b) { return rmsDifference(a, b); }

}  // namespace

TEST_CASE("On the CPU slabs that emit, absorbing or not, have their closed form", "[sweep][emission]") {
  const ScalarGrid grid = withEmission(ascendingGrid(), ascendingGrid());
  for (const bool perspective : {false, true})
    for (const double sigma_t : {0.0, 0.05, 0.4, 3.0}) {
      const glm::dvec3 eye(24, 12, 36), at(12, 12, 6);
      const Camera camera = perspective ? perspectiveCamera(eye, at, 0.1, 5) : orthographicCamera(eye, at, 4, 5);
      const glm::dvec3 grey(0.7);
      const TransferFunction medium(
          {{kSlabLow, {grey, 0}}, {kSlabLow, {grey, sigma_t}}, {kSlabHigh, {grey, sigma_t}}, {kSlabHigh, {grey, 0}}});
      ResolvedScene scene = fireScene(medium, glowing(kFire, kSlabLow, kSlabHigh), camera, 0.5, 0.5);
      scene.clipPlanes = {{0, 0, -1, 20}};  // above, values fall back to the background, through those of the slab
      const Image picture = byRays(grid, scene, {}, 4).colour;
      for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 5; ++x) {
          const ViewRay ray = viewRay(camera, x + 0.5, y + 0.5);
          const double d = (kSlabHigh - kSlabLow) * ray.stretch() / std::abs(ray.direction.z);
          const double alpha = -std::expm1(-sigma_t * d);
          const glm::dvec3 expected = kFire * (sigma_t > 0 ? alpha / sigma_t : d) + 0.5 * alpha * grey;
          for (int c = 0; c < 3; ++c) {
            INFO("sigma_t " << sigma_t << ", " << picture.at(x, y)[c] << " of " << expected[c]);
            // Within a segment that a face of the slab cuts, medium and emission count as spread evenly over parts.
            CHECK(picture.at(x, y)[c] == Approx(expected[c]).epsilon(sigma_t > 1 ? 0.02 : 0.002));
          }
        }
    }
}

TEST_CASE("Fire in and beside smoke approaches the reference on the CPU", "[sweep][emission]") {
  const ScalarGrid straight = burningGrid();
  for (const double sigma_t : {0.15, 2.0})
    for (const bool perspective : {false, true}) {
      const ResolvedScene scene = fireScene(ramp(sigma_t), fading(0.5), onFire(perspective), 0.5, 0.4);
      const Image exact = renderReference(straight, scene).colour;
      const Image coarse = byRays(straight, scene, {}, 2).colour, fine = byRays(straight, scene, {}, 4).colour;
      const double change = rmsOfColours(coarse, fine), rest = rmsOfColours(fine, exact);
      INFO("sigma_t " << sigma_t << ": change by twice the sampling " << change << ", left to the reference " << rest);
      CHECK(change < 1e-2);
      CHECK(rest < 0.6 * change + 5e-5);  // as checkOnCpu
    }
}

TEST_CASE("Crooked lattices, 2D functions and clip planes show the same fire as the reference", "[sweep][emission]") {
  const ScalarGrid grid = withTransform(burningGrid(), crookedTransform());
  Camera base;
  base.width = base.height = 24;
  ResolvedScene scene = fireScene(ramp(0.3), fading(0.5), orbitCamera(grid.worldBounds(), 0.7, 0.4, base), 0.5, 0.4);
  SECTION("crooked") {}
  SECTION("clipped") {
    const glm::dvec3 middle = grid.worldBounds().centre();
    const glm::dvec3 normal(0.3, -0.8, 0.5);
    scene.clipPlanes = {{normal, -glm::dot(normal, middle)}};
  }
  SECTION("2D") { scene.transfer = withGradientOpacity(ramp(0.3), {0.001, 0.05}); }
  SECTION("midpoint") { scene.sampling.quadrature = Quadrature::midpoint; }
  const Image exact = renderReference(grid, scene).colour;
  const Image coarse = byRays(grid, scene, {}, 4).colour, fine = byRays(grid, scene, {}, 8).colour;
  const double change = rmsOfColours(coarse, fine), rest = rmsOfColours(fine, exact);
  INFO("change by twice the sampling " << change << ", left to the reference " << rest);
  CHECK(change < 1e-2);
  CHECK(rest < 0.6 * change + 2e-4);
}

TEST_CASE("Bricks and culling change nothing of a fire, also where it is all there is", "[sweep][emission]") {
  const ScalarGrid burning = burningGrid();
  for (const TransferFunction& medium : {ramp(0.3), clearAir()}) {
    ResolvedScene scene = fireScene(medium, fading(0.5), onFire(true), 0.5, 0.4);
    scene.bricks.bricked = false;
    scene.bricks.culling = false;
    const Image whole = byRays(burning, scene).colour;
    CHECK(*std::ranges::max_element(whole.pixels) > 0.3f);
    scene.bricks.bricked = true;
    for (const int interior : {8, 16, 24})
      for (const bool culling : {false, true}) {
        INFO("interior " << interior << ", culling " << culling);
        scene.bricks.interior = interior;
        scene.bricks.culling = culling;
        CHECK(maxDifference(whole, byRays(burning, scene).colour) < 2e-5);  // rounding over some 100 samples
        if (interior != 8) continue;
        scene.bricks.budgetMiB = 1;  // bands of rows, whose bricks are read one after another
        CHECK(maxDifference(whole, byRays(burning, scene).colour) < 2e-5);
        scene.bricks.budgetMiB = 2048;
      }
  }
}

TEST_CASE("A fire is lit, put out and changed by setters", "[sweep][emission]") {
  const ScalarGrid burning = burningGrid();
  const ResolvedScene lit = fireScene(ramp(0.3), fading(0.5), onFire(true), 0.5, 0.4);
  ResolvedScene dark = lit;
  dark.volume.emissionGrid.clear();
  dark.emitted.reset();
  const ResolvedScene brighter = fireScene(ramp(0.3), fading(1), onFire(true), 0.5, 0.4);
  const auto bricks = cpuBricksFor(burning, lit);
  RayRenderer renderer(*bricks, dark);
  for (const ResolvedScene& scene : {dark, lit, brighter, dark}) {
    renderer.setScene(scene);
    CHECK(renderer.render().colour.pixels == byRays(burning, scene).colour.pixels);
  }
}

TEST_CASE("What does not show emission says what does", "[sweep][emission]") {
  const ScalarGrid burning = burningGrid();
  ResolvedScene scene = fireScene(ramp(0.3), fading(0.5), onFire(true));
  CHECK(complaint<InvalidArgument>([&] { shearWarped(burning, scene); }).find("but by slices, stacks, rays") !=
        std::string::npos);
  CHECK(complaint<InvalidArgument>([&] { byRays(makeSparse(), scene); }).find("'fire'") != std::string::npos);
  scene.sampling.classification = Classification::pre;
  CHECK(complaint<InvalidArgument>([&] { byRays(burning, scene); }).find("sampling.classification") !=
        std::string::npos);
}
