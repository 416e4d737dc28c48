// The light that reaches surfaces, and media that reflect it, by rays on OpenGL: against closed forms, rays on the CPU
// and the reference.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "support/gl_fixture.h"
#include "support/lit_surfaces.h"
#include "support/observed_order.h"
#include "sweep/value_picture.h"
#include "umbrick/core/error.h"
#include "umbrick/shade/ray_caster.h"

using namespace umbrick;
using Catch::Contains;

namespace {

Picture castLit(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene,
                const RenderOptions& options = {}, const AtlasLimits& limits = {}) {
  const auto volume = valueBricks(grid, scene);
  return RayCaster(context, *volume, scene, options, limits).render();
}

}  // namespace

TEST_CASE("A surface below a slab gets on OpenGL what the slab lets through", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = floorGrid();
  const glm::dvec3 colour(0.8, 0.6, 0.4), radiance(1, 0.5, 0.25), towards(std::sin(0.5), 0, std::cos(0.5));
  RenderOptions options;
  options.visibilityAndDepth = true;
  for (const double sigma : {0.05, 0.3}) {
    ResolvedScene scene = floorScene(sigma, towards, radiance);
    const double share = std::exp(-slabDepth(sigma) / std::cos(0.5));
    for (const bool phong : {false, true}) {
      scene.shading = {phong ? Shading::phong : Shading::none, ShadingLight::automatic, 0.2, 0.7, 0, 1};
      const Picture ours = castLit(*context, grid, scene, options);
      for (int c = 0; c < 3; ++c)
        CHECK(ours.colour.at(1, 2)[c] ==
              Approx(colour[c] * (phong ? 0.2 + share * radiance[c] * 0.7 * std::cos(0.5) : share * radiance[c]))
                  .margin(2e-4));
      CHECK(*ours.visibility.at(1, 2) == Approx(share).margin(2e-4));
    }
  }
}

TEST_CASE("Surfaces keep their opacity of the light away on OpenGL", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = floorGrid();
  for (const double opacity : {0.4, 1.0})
    CHECK(castLit(*context, grid, roofScene(opacity)).colour.at(1, 2)[0] ==
          Approx(0.8 * roofShare(opacity)).margin(2e-5));
}

TEST_CASE("Lit surfaces on OpenGL are those of the CPU and of the reference", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = withTransform(blobGrid(), crookedTransform());
  ReferenceOptions exactly;
  exactly.directions = 64;
  for (int kind = 0; kind < 4; ++kind) {
    ResolvedScene scene = litBlobs(grid, kind % 2 ? Projection::perspective : Projection::orthographic, kind, 24);
    CAPTURE(kind);
    const Picture ours = castLit(*context, grid, scene);
    // Filters of textures round what lies between voxels; normals are single precision.
    CHECK(rmsDifference(ours.colour, valuePicture(grid, scene).colour) < 1e-3);
    CHECK(rmsDifference(ours.colour, renderReference(grid, scene, exactly).colour) < 4e-3);
    AtlasLimits small;
    small.budgetBytes = ours.stats.textureBytes / 6;
    CHECK(maxDifference(castLit(*context, grid, scene, {}, small).colour, ours.colour) < 1e-3);
    if (kind > 0) continue;
    RenderOptions onGl;
    onGl.lightSweep = LightSweep::gl;
    const Picture noted = castLit(*context, grid, scene, onGl);
    CHECK(noted.stats.lightNote == "the light of surfaces is computed on the CPU");
    CHECK(maxDifference(noted.colour, ours.colour) == 0);
    scene.mode = Mode::hybrid;
    CHECK(rmsDifference(castLit(*context, grid, scene).colour, valuePicture(grid, scene, 4).colour) < 2e-3);
  }
}

TEST_CASE("A medium that reflects light on OpenGL is dimmed by what is in its way", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ReflectingBlock block;
  const Image colour = castLit(*context, block.grid, block.scene).colour;
  double worst = 0;
  for (std::size_t i = 0; i < colour.pixels.size(); i += 4)
    for (int c = 0; c < 3; ++c)
      worst = std::max(
          worst, std::abs(colour.pixels[i + static_cast<std::size_t>(c)] - block.colourOf(colour.pixels[i + 3], c)));
  CHECK(colour.pixels[3] > 0.5);
  CHECK(worst < 3e-3);  // light is interpolated linearly between voxels, and behind planes that cut them
  const ScalarGrid grid = blobGrid();
  for (const int kind : {0, 2}) {
    ResolvedScene scene = litBlobs(grid, Projection::perspective, kind, 24);
    scene.mode = Mode::integrate;
    scene.shading.kind = Shading::phong;
    scene.sampling.spacing = 0.25;
    CHECK(rmsDifference(castLit(*context, grid, scene).colour, valuePicture(grid, scene, 4).colour) < 2e-3);
  }
}

TEST_CASE("Light on surfaces comes and goes with a scene on OpenGL", "[shade][rays][modes][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  const ResolvedScene lit = litBlobs(grid, Projection::perspective, 0, 16);
  ResolvedScene plain = lit, medium = lit;
  plain.model = Model::emission;
  medium.mode = Mode::integrate;
  const auto bricks = valueBricks(grid, lit);
  RayCaster renderer(*context, *bricks, lit);
  for (const ResolvedScene& scene : {plain, lit, medium, lit}) {
    renderer.setScene(scene);
    // Light that was swept as an edit is off by half a step of 1/65535 more.
    CHECK(maxDifference(renderer.render().colour, RayCaster(*context, *bricks, scene).render().colour) < 2e-5);
  }
  ResolvedScene refused = lit;
  refused.method = Method::dos;
  CHECK_THROWS_WITH(renderer.setScene(refused), Contains("surfaces take light from a light volume"));
}
