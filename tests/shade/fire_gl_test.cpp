// Light that a second grid emits, on OpenGL: closed forms, the reference, and what must not change it.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include "shade/hard_case.h"
#include "support/closed_forms.h"
#include "support/complaint.h"
#include "support/fire_scene.h"
#include "umbrick/core/error.h"
#include "umbrick/shade/ray_caster.h"

using namespace umbrick;

namespace {

constexpr Technique kFireTechniques[]{Technique::slices, Technique::stacks, Technique::rays};

Image fireOnGl(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene) {
  const auto bricks =
      cutGrid(grid, requiredBricks(scene, grid.indexToWorld(), grid.worldBounds()), scene.bricks.bricked);
  if (scene.technique == Technique::rays) return RayCaster(context, *bricks, scene).render().colour;
  return renderPicture(context, *bricks, scene).colour;
}

ScalarGrid smokeAndFire() { return withEmission(makeSparse({0, 0, 0}, 1, 8, 40), makeSparse({3, -2, 5}, 2, 8, 40)); }

TransferFunction flames(double brightest) {
  return TransferFunction({{0.2, {{1, 0.6, 0.2}, 0}}, {0.9, {{1, 0.8, 0.5}, brightest}}});
}

Camera atTheFire(int size = 24) { return perspectiveCamera({53, -30, 50}, {20, 20, 22}, 0.8, size); }

}  // namespace

TEST_CASE("On OpenGL a slab that emits and absorbs has its closed form", "[shade][emission][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid height = fieldGrid(
      {glm::ivec3(-2, -2, 0), glm::ivec3(26, 26, 24)}, [](const glm::dvec3& p) { return p.z; }, glm::dmat4(1), -1);
  const ScalarGrid grid = withEmission(height, height);
  const glm::dvec3 fire(3, 1, 0.25), grey(0.7);
  for (const Technique technique : kFireTechniques)
    for (const double sigma_t : {0.0, 0.05, 0.4}) {
      const TransferFunction medium(
          {{5.3, {grey, 0}}, {5.3, {grey, sigma_t}}, {8.6, {grey, sigma_t}}, {8.6, {grey, 0}}});
      ResolvedScene scene =
          fireScene(medium, glowing(fire, 5.3, 8.6), orthographicCamera({24, 12, 36}, {12, 12, 6}, 4, 5), 0.25, 0.5);
      scene.technique = technique;
      scene.clipPlanes = {{0, 0, -1, 20}};  // above, values fall back to the background, through those of the slab
      const Image picture = fireOnGl(*context, grid, scene);
      for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 5; ++x) {
          const ViewRay ray = viewRay(scene.camera, x + 0.5, y + 0.5);
          const double d = 3.3 * ray.stretch() / std::abs(ray.direction.z), alpha = -std::expm1(-sigma_t * d);
          const glm::dvec3 expected = fire * (sigma_t > 0 ? alpha / sigma_t : d) + 0.5 * alpha * grey;
          for (int c = 0; c < 3; ++c) {
            INFO(techniqueName(technique)
                 << ", sigma_t " << sigma_t << ": " << picture.at(x, y)[c] << " of " << expected[c]);
            // Within the segment that a face of the slab cuts, medium and emission count as spread evenly.
            CHECK(picture.at(x, y)[c] == Approx(expected[c]).epsilon(0.002));
          }
        }
    }
}

TEST_CASE("Fire in and beside smoke approaches the reference on OpenGL", "[shade][emission][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = smokeAndFire();
  for (const Technique technique : kFireTechniques)
    for (const double sigma_t : {0.15, 2.0}) {
      ResolvedScene scene = fireScene(ramp(sigma_t), flames(0.5), atTheFire(), 0.5, 0.4);
      scene.technique = technique;
      const Image exact = renderReference(grid, scene).colour;
      const Image coarse = fireOnGl(*context, grid, scene);
      scene.sampling.spacing /= 2;
      const Image fine = fireOnGl(*context, grid, scene);
      const double change = rmsDifference(coarse, fine), rest = rmsDifference(fine, exact);
      INFO(techniqueName(technique) << ", sigma_t " << sigma_t << ": change by half the distance " << change
                                    << ", left to the reference " << rest);
      CHECK(change < 1e-2);
      CHECK(rest < 0.6 * change + 5e-5);  // as checkAgainstReference
    }
}

TEST_CASE("Bricks and culling change nothing of a fire on OpenGL, also where it is all there is",
          "[shade][emission][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = smokeAndFire();
  for (const Technique technique : {Technique::slices, Technique::rays})
    for (const TransferFunction& medium : {ramp(0.3), clearAir()}) {
      ResolvedScene scene = fireScene(medium, flames(0.5), atTheFire(), 0.5, 0.4);
      scene.technique = technique;
      scene.bricks.bricked = false;
      scene.bricks.culling = false;
      const Image whole = fireOnGl(*context, grid, scene);
      CHECK(*std::ranges::max_element(whole.pixels) > 0.3f);
      scene.bricks.bricked = true;
      for (const int interior : {8, 16})
        for (const bool culling : {false, true}) {
          INFO(techniqueName(technique) << ", interior " << interior << ", culling " << culling);
          scene.bricks.interior = interior;
          scene.bricks.culling = culling;
          CHECK(maxDifference(whole, fireOnGl(*context, grid, scene)) < 5e-5);  // rounding over some 100 segments
        }
    }
}

TEST_CASE("Every method of light adds the same fire", "[shade][emission][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = smokeAndFire();
  ResolvedScene dark = fireScene(ramp(0.3), flames(0.5), atTheFire(), 0.5, 0);
  dark.emission.lightsMedium = false;                          // which light volumes alone know
  const Image fire = renderGrid(*context, grid, dark).colour;  // nothing is lit but what glows
  for (const Method method : {Method::dos, Method::ordinates, Method::lightVolume}) {
    INFO(methodName(method));
    ResolvedScene lit = dark;
    lit.model = Model::cone;
    lit.method = method;
    CHECK(maxDifference(fire, renderGrid(*context, grid, lit).colour) < 2e-5);
    // Light and fire add up.
    lit.ambient = glm::dvec3(0.7, 0.6, 0.5);
    ResolvedScene smoke = lit;
    smoke.volume.emissionGrid.clear();
    smoke.emitted.reset();
    Image sum = renderGrid(*context, grid, smoke).colour;
    for (std::size_t i = 0; i < sum.pixels.size(); ++i)
      if (i % 4 != 3) sum.pixels[i] += fire.pixels[i];
    CHECK(maxDifference(sum, renderGrid(*context, grid, lit).colour) < 5e-5);
  }
}

TEST_CASE("On OpenGL what cannot hold a fire is refused", "[shade][emission][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = smokeAndFire();
  ResolvedScene scene = fireScene(ramp(0.3), flames(0.5), atTheFire());
  CHECK(complaint<InvalidArgument>([&] { renderGrid(*context, makeSparse(), scene); }).find("'fire'") !=
        std::string::npos);
  scene.bricks.format = "half";
  CHECK(complaint<InvalidArgument>([&] { renderGrid(*context, grid, scene); }).find("float32") != std::string::npos);
  scene.bricks.format = "auto";
  scene.sampling.bits = 16;
  CHECK(complaint<InvalidArgument>([&] { renderGrid(*context, grid, scene); }).find("sampling.bits") !=
        std::string::npos);
}

TEST_CASE("On OpenGL fire lights the smoke as in the reference, by every technique", "[shade][emission][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = smokeAndFire();
  ResolvedScene scene = fireScene(ramp(0.4), flames(0.3), atTheFire(12), 0.25, 0.3);
  scene.model = Model::ambient;
  scene.method = Method::lightVolume;
  scene.occlusion.ordinates.directions = 32;
  ResolvedScene unlit = scene;
  unlit.emission.lightsMedium = false;
  ReferenceOptions options;
  options.directions = 64;
  options.tolerance = 0.01;
  const Image exact = renderReference(grid, scene, options).colour, less = renderReference(grid, unlit, options).colour;
  const double bounce = rmsDifference(exact, less);
  CHECK(bounce > 0.02);
  for (const Technique technique : kFireTechniques) {
    scene.technique = unlit.technique = technique;
    const double off = rmsDifference(fireOnGl(*context, grid, scene), exact);
    const double without = rmsDifference(fireOnGl(*context, grid, unlit), less);
    INFO(techniqueName(technique) << ": the bounce is " << bounce << ", off by " << off << ", without it by "
                                  << without);
    CHECK(off < 0.1 * bounce + without);  // its cells, see glow_light.h
  }
}
