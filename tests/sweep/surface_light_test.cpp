// The light that reaches surfaces, and media that reflect it, by rays on the CPU: against closed forms and the
// reference.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "support/lit_surfaces.h"
#include "support/observed_order.h"
#include "sweep/value_picture.h"
#include "umbrick/core/error.h"
#include "umbrick/sweep/shear_warp_renderer.h"

using namespace umbrick;
using Catch::Contains;

namespace {

// Light is stored in steps of 1/65535.
constexpr double kStep = 2e-5;
// The extinction of a function is a table of 4096 steps, and a voxel's value the nearest of them.
constexpr double kTable = 2e-4;

}  // namespace

TEST_CASE("A surface below a slab gets what the slab lets through", "[sweep][cpu][modes]") {
  const ScalarGrid grid = floorGrid();
  const glm::dvec3 colour(0.8, 0.6, 0.4), radiance(1, 0.5, 0.25);
  for (const double sigma : {0.05, 0.3, 100.0}) {
    const glm::dvec3 towards(std::sin(0.5), 0, std::cos(0.5));
    ResolvedScene scene = floorScene(sigma, towards, radiance);
    scene.ambient = {0.9, 0.8, 0.7};
    const double share = std::exp(-slabDepth(sigma) / std::cos(0.5));
    CAPTURE(sigma);
    for (const bool phong : {false, true}) {
      scene.shading = {phong ? Shading::phong : Shading::none, ShadingLight::automatic, 0.2, 0.7, 0, 1};
      const Picture ours = valuePicture(grid, scene, {}, true);
      const ReferencePicture exact = renderReference(grid, scene);
      for (int c = 0; c < 3; ++c) {
        const double lit = scene.ambient[c] * colour[c] *
                           (phong ? 0.2 + share * radiance[c] * 0.7 * std::cos(0.5) : share * radiance[c]);
        CHECK(exact.colour.at(1, 2)[c] == Approx(lit).margin(1e-6));
        CHECK(ours.colour.at(1, 2)[c] == Approx(lit).margin(kTable));
      }
      CHECK(*ours.visibility.at(1, 2) == Approx(share).margin(kTable));
      CHECK(*exact.visibility.at(1, 2) == Approx(share).margin(1e-6));
    }
  }
}

TEST_CASE("A surface that nothing occludes looks as under emission", "[sweep][cpu][modes]") {
  const ScalarGrid grid = floorGrid();
  ResolvedScene scene = floorScene(0, {0, 0, 1}, glm::dvec3(1));
  for (const Shading shading : {Shading::none, Shading::phong}) {
    scene.shading.kind = shading;
    scene.model = Model::emission;
    const Image plain = valuePicture(grid, scene).colour;
    scene.model = Model::cone;
    scene.occlusion.aperture = 0.6;
    CHECK(maxDifference(valuePicture(grid, scene).colour, plain) < 1e-6);
    CHECK(maxDifference(renderReference(grid, scene).colour, plain) < 1e-6);
  }
}

TEST_CASE("Surfaces keep their opacity of the light away", "[sweep][cpu][modes]") {
  const ScalarGrid grid = floorGrid();
  for (const double opacity : {0.0, 0.4, 1.0}) {
    const ResolvedScene scene = roofScene(opacity);
    CAPTURE(opacity);
    CHECK(valuePicture(grid, scene).colour.at(1, 2)[0] == Approx(0.8 * roofShare(opacity)).margin(kStep));
    CHECK(renderReference(grid, scene).colour.at(1, 2)[0] == Approx(0.8 * roofShare(opacity)).margin(1e-6));
  }
}

TEST_CASE("Half of the whole sphere is behind a plane", "[sweep][cpu][modes]") {
  const ScalarGrid grid =
      makeFilled({64, 64, 24}, glm::ivec3(0), [](const glm::ivec3& i) { return i.z <= 8 ? 1.0 : 0.0; });
  ResolvedScene scene = floorScene(0, {0, 0, 1}, glm::dvec3(1));
  scene.camera = orthographicCamera({31.5, 31.5, 60}, {31.5, 31.5, 8}, 6, 4);
  scene.shading.kind = Shading::none;
  scene.model = Model::ambient;
  scene.occlusion.ordinates.directions = 256;
  // Beyond the plane's edges, 31 voxels away, a little light comes from below: 1 - sin of the angle to there.
  ReferenceOptions options;
  options.directions = 256;
  const float ours = valuePicture(grid, scene).colour.at(1, 2)[0] / 0.8f;
  const float exact = renderReference(grid, scene, options).colour.at(1, 2)[0] / 0.8f;
  CHECK(exact == Approx(0.5).margin(0.05));
  CHECK(ours == Approx(exact).margin(5e-3));
}

// Light is interpolated between voxels, as in a medium.
TEST_CASE("Lit surfaces are those of the reference", "[sweep][cpu][modes]") {
  const ScalarGrid grid = withTransform(blobGrid(), crookedTransform());
  ReferenceOptions options;
  options.directions = 64;
  for (int kind = 0; kind < 4; ++kind) {
    const ResolvedScene scene = litBlobs(grid, kind % 2 ? Projection::perspective : Projection::orthographic, kind, 24);
    CAPTURE(kind);
    const ReferencePicture exact = renderReference(grid, scene, options);
    const Picture ours = valuePicture(grid, scene, {}, true);
    const double rms = rmsDifference(ours.colour, exact.colour), v = rmsDifference(ours.visibility, exact.visibility);
    CAPTURE(rms, v);
    CHECK(largestAlpha(exact.colour) > 0.9);
    CHECK(rms < 4e-3);
    CHECK(v < 6e-3);
    ResolvedScene unlit = scene;
    unlit.model = Model::emission;
    CHECK(rmsDifference(valuePicture(grid, unlit).colour, exact.colour) > 4 * rms);
  }
}

TEST_CASE("Light on the first surface and in the medium behind it is that of the reference", "[sweep][cpu][modes]") {
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = litBlobs(grid, Projection::perspective, 0, 24);
  scene.mode = Mode::hybrid;
  ReferenceOptions options;
  options.directions = 64;
  for (const Shading shading : {Shading::automatic, Shading::phong}) {
    scene.shading.kind = shading;
    const ReferencePicture exact = renderReference(grid, scene, options);
    const double rms = rmsDifference(valuePicture(grid, scene, 4).colour, exact.colour);
    CAPTURE(rms);
    CHECK(rms < 4e-3);
  }
}

TEST_CASE("Bricks change nothing about the light of surfaces", "[sweep][cpu][modes]") {
  const ScalarGrid grid = blobGrid({-5, 3, 7});
  ResolvedScene scene = litBlobs(grid, Projection::perspective, 0, 40);
  scene.bricks.interior = 8;
  const Image small = valuePicture(grid, scene).colour;
  scene.bricks.bricked = false;
  CHECK(maxDifference(valuePicture(grid, scene).colour, small) < kStep);
}

TEST_CASE("A medium that reflects light is dimmed by what is in its way", "[sweep][cpu][modes]") {
  const ReflectingBlock block;
  const Image colour = valuePicture(block.grid, block.scene, 4).colour;
  const Image exact = renderReference(block.grid, block.scene).colour;
  double worst = 0, worstExact = 0;
  for (std::size_t i = 0; i < colour.pixels.size(); i += 4)
    for (int c = 0; c < 3; ++c) {
      const std::size_t at = i + static_cast<std::size_t>(c);
      worst = std::max(worst, std::abs(colour.pixels[at] - block.colourOf(colour.pixels[i + 3], c)));
      worstExact = std::max(worstExact, std::abs(exact.pixels[at] - block.colourOf(exact.pixels[i + 3], c)));
    }
  CHECK(colour.pixels[3] > 0.5);
  CHECK(worst < 3e-3);       // light is interpolated linearly between voxels, and behind planes that cut them
  CHECK(worstExact < 1e-3);  // as good as its tolerance
}

TEST_CASE("A medium that reflects what reaches it is that of the reference", "[sweep][cpu][modes]") {
  const ScalarGrid grid = blobGrid();
  ReferenceOptions options;
  options.directions = 64;
  for (const int kind : {0, 2}) {
    ResolvedScene scene = litBlobs(grid, Projection::perspective, kind, 24);
    scene.mode = Mode::integrate;
    scene.shading.kind = Shading::phong;
    CAPTURE(kind);
    const ReferencePicture exact = renderReference(grid, scene, options);
    const Picture ours = valuePicture(grid, scene, 4, true);
    const auto bricks = valueBricks(grid, scene);
    const Image warped = ShearWarpRenderer(*bricks, scene, {}, ShearWarpSampling{4, 4}).render().colour;
    const double rms = rmsDifference(ours.colour, exact.colour), warp = rmsDifference(warped, exact.colour);
    CAPTURE(rms, warp);
    CHECK(rms < 3e-3);
    CHECK(warp < 4e-3);
    CHECK(rmsDifference(ours.visibility, exact.visibility) < 1e-3);
    scene.model = Model::emission;
    CHECK(rmsDifference(valuePicture(grid, scene, 4).colour, exact.colour) > 0.02);
  }
}

TEST_CASE("Light of surfaces that cannot be computed is refused in one line", "[sweep][cpu][modes]") {
  const ScalarGrid grid = blobGrid();
  ResolvedScene scene = litBlobs(grid, Projection::perspective, 0, 8);
  scene.method = Method::ordinates;
  CHECK_THROWS_WITH(valuePicture(grid, scene),
                    "method: ordinates is one of slices; surfaces take light from a light volume");
  scene.method = Method::lightVolume;
  scene.model = Model::coneRay;
  CHECK_THROWS_WITH(valuePicture(grid, scene), Contains("model: cone-ray on surfaces is integrated by the reference"));
  ReferenceOptions options;
  options.integrator = Integrator::monteCarlo;
  CHECK_THROWS_WITH(renderReference(grid, scene, options), Contains("integrated by quadrature, not by Monte Carlo"));
}
