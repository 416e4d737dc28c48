// A mesh in the volume, by rays on the CPU: against closed forms, a cut and the reference.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "support/mesh_scenes.h"
#include "support/observed_order.h"
#include "sweep/value_picture.h"
#include "umbrick/core/error.h"
#include "umbrick/sweep/shear_warp_renderer.h"

using namespace umbrick;
using Catch::Contains;

TEST_CASE("A sphere in a slab is seen through what lies in front of it", "[sweep][cpu][mesh]") {
  const glm::dvec3 albedo(0.9, 0.6, 0.3), colour(0.2, 0.7, 0.4), centre(16, 15, 14);
  constexpr double kSigma = 0.08, kRadius = 6, kTop = 27;
  const ScalarGrid grid = makeFilled(glm::ivec3(32), glm::ivec3(0), [](const glm::ivec3&) { return 1.0; });
  ResolvedScene scene =
      plainScene(homogeneous(albedo, kSigma), orthographicCamera({16, 15, 90}, {16, 15, 14}, 16, 33), 0.5);
  scene.camera.up = {0, 1, 0};
  scene.clipBox = Box{glm::dvec3(2), glm::dvec3(30, 30, kTop)};
  scene.shading = {Shading::none, ShadingLight::automatic, 0.2, 0.8, 0, 1};
  for (const bool phong : {false, true}) {
    // A medium that reflects light would do so by the model of its own.
    if (phong) scene.shading.kind = Shading::automatic;
    scene.mesh = sceneMesh(sphereMesh(centre, kRadius, 90), colour);
    const Picture picture = valuePicture(grid, scene, 2, true);
    const ReferencePicture reference = renderReference(grid, scene);
    int met = 0;
    double worst = 0, worstExact = 0, worstDepth = 0;
    for (int y = 0; y < 33; ++y)
      for (int x = 0; x < 33; ++x) {
        const glm::dvec2 aside = (glm::dvec2(x, y) - 16.0) * (16.0 / 33);
        const double square = kRadius * kRadius - glm::dot(aside, aside);
        // At the silhouette chords of the sphere are seen, and the little that they are lower is far along the ray.
        if (std::abs(square) < 0.1 * kRadius * kRadius) continue;
        const double height = square > 0 ? centre.z + std::sqrt(square) : 2, facing = std::sqrt(std::max(square, 0.0));
        const double tau = kSigma * (kTop - height), alpha = 1 - std::exp(-tau);
        const double shade = phong ? 0.2 + 0.8 * facing / kRadius : 1;
        met += square > 0;
        for (int c = 0; c < 3; ++c) {
          const double seen = albedo[c] * alpha + (square > 0 ? (1 - alpha) * colour[c] * shade : 0);
          worst = std::max(worst, std::abs(picture.colour.at(x, y)[c] - seen));
          worstExact = std::max(worstExact, std::abs(reference.colour.at(x, y)[c] - seen));
        }
        if (!(square > 0)) continue;
        CHECK(picture.colour.at(x, y)[3] == 1);
        CHECK(*picture.opacity.at(x, y) == 1);
        // The mean depth of a medium of depth d is its integral, and the mesh has the rest.
        const double d = kTop - height, medium = (1 - (1 + tau) * std::exp(-tau)) / kSigma;
        const double depth = 90 - kTop + medium + (1 - alpha) * d;
        worstDepth = std::max(worstDepth, std::abs(*picture.depth.at(x, y) - depth));
        CHECK(*reference.depth.at(x, y) == Approx(depth).margin(5e-3));
      }
    CHECK(met > 200);
    // Corners of triangles are 0.21 apart, so that their chords lie up to 0.0018 lower, and up to 3 times that far
    // along rays where they slope; normals are interpolated linearly.
    CHECK(worst < 1e-3);
    CHECK(worstExact < 1e-3);
    CHECK(worstDepth < 1e-2);
  }
}

TEST_CASE("A wall shows of each mode what a clip plane leaves in front of it", "[sweep][cpu][mesh]") {
  const ScalarGrid grid = blobGrid();
  for (const Mode mode : kAllModes) {
    CAPTURE(modeName(mode));
    const ResolvedScene scene = wallScene(mode);
    const Picture walled = valuePicture(grid, scene, 2), cut = valuePicture(grid, cutAtWall(scene), 2);
    double worst = 0;
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 20; ++x) {
        for (int c = 0; c < 3; ++c)
          worst = std::max(worst, std::abs(walled.colour.at(x, y)[c] - overWall(scene, cut.colour.at(x, y), c)));
        CHECK(walled.colour.at(x, y)[3] == 1);
      }
    // A depth of some 50 voxels is single precision.
    CHECK(worst < 2e-5);
    if (traitsOf(mode).projection) CHECK(maxDifference(layerOf(walled, "value"), layerOf(cut, "value")) < 1e-5);
  }
}

TEST_CASE("A scene with a mesh is that of the reference in each mode", "[sweep][cpu][mesh]") {
  const ScalarGrid grid = blobGrid();
  for (const Mode mode : kAllModes)
    for (const Camera& camera : smallCameras(24)) {
      CAPTURE(modeName(mode));
      ResolvedScene scene = meshScene(mode, camera);
      scene.background = glm::dvec3(0.1, 0.2, 0.5);
      if (mode == Mode::integrate) scene.sampling.pixelSamples = 3;
      if (mode == Mode::isosurface) scene.camera.nearDistance = 35;  // a part of the sphere is nearer
      if (mode == Mode::xray) {
        CHECK_THROWS_WITH(renderReference(grid, scene), Contains("mesh: the mode xray is not integrated with one"));
        continue;
      }
      const ReferencePicture exact = renderReference(grid, scene);
      const Picture ours = valuePicture(grid, scene, 8);
      // Of projections the number: where it is next to nothing a pixel may be clear or black.
      const bool number = traitsOf(mode).projection;
      const double rms = number ? rmsDifference(layerOf(ours, "value"), layerOf(exact, "value"))
                                : rmsDifference(ours.colour, exact.colour);
      CAPTURE(rms);
      CHECK(rms < 1e-3);
      ResolvedScene bare = scene;
      bare.mesh = {};
      CHECK(rmsDifference(valuePicture(grid, bare, 8).colour, exact.colour) > 0.03);
    }
}

TEST_CASE("A mesh beside the picture keeps its light from a slab", "[sweep][cpu][mesh]") {
  const ScalarGrid grid = makeFilled(glm::ivec3(32), glm::ivec3(0), [](const glm::ivec3&) { return 1.0; });
  const Medium solid{{0.9, 0.6, 0.3}, 0.2};
  ResolvedScene scene = plainScene(TransferFunction({{0, solid}, {1, solid}}),
                                   orthographicCamera({16, 15, 50}, {16, 15, 14}, 16, 33), 0.25);
  scene.camera.up = {0, 1, 0};
  scene.clipBox = Box{glm::dvec3(2), glm::dvec3(30, 30, 6)};
  scene.model = Model::lights;
  scene.lights = {{LightFrame::world, ConeLight{{1, 0, 1}, 0, glm::dvec3(1)}}};
  for (const Method method : {Method::lightVolume, Method::coneRays}) {
    scene.method = method;
    scene.mesh = {};
    const Image bare = valuePicture(grid, scene).colour;
    // Higher than the eye, and outside of the volume: of a point of height z all beyond x = 12 + z is dark.
    scene.mesh = sceneMesh(squareMesh({72, -50}, {200, 80}, 60), {0.2, 0.7, 0.4});
    const Image ours = valuePicture(grid, scene).colour, exact = renderReference(grid, scene).colour;
    for (int y = 0; y < 33; ++y)
      for (int x = 0; x < 33; ++x) {
        const double place = 16 + (x - 16) * (16.0 / 33);
        CHECK(ours.at(x, y)[3] == bare.at(x, y)[3]);
        for (int c = 0; c < 3; ++c) {
          if (place < 13) CHECK(ours.at(x, y)[c] == bare.at(x, y)[c]);
          if (place > 19) CHECK(ours.at(x, y)[c] < 2e-5);
          if (place > 18) CHECK(exact.at(x, y)[c] == 0);
        }
      }
    CHECK(rmsDifference(ours, exact) < (method == Method::coneRays ? 3e-3 : 1.5e-2));
  }
}

TEST_CASE("The shadow of a mesh is that of the reference", "[sweep][cpu][mesh]") {
  const ScalarGrid grid = blobGrid();
  for (const Camera& camera : smallCameras(24))
    for (const Mode mode : {Mode::integrate, Mode::isosurface, Mode::hybrid}) {
      CAPTURE(modeName(mode));
      ResolvedScene scene = shadowScene(mode, camera);
      const Image exact = renderReference(grid, scene).colour;
      const double rms = rmsDifference(valuePicture(grid, scene, 4).colour, exact);
      CAPTURE(rms);
      // At the edges of a shadow light is interpolated over a voxel.
      CHECK(rms < 7e-3);
      ResolvedScene bare = scene;
      bare.model = Model::emission;
      CHECK(rmsDifference(valuePicture(grid, bare, 4).colour, exact) > 10 * rms);
      if (mode != Mode::integrate) continue;
      scene.method = Method::coneRays;
      CHECK(rmsDifference(valuePicture(grid, scene, 4).colour, exact) < 2.5e-3);
    }
}

TEST_CASE("A mesh comes and goes with a scene, and is refused where it is not drawn", "[sweep][cpu][mesh]") {
  const ScalarGrid grid = blobGrid();
  ResolvedScene with = meshScene(Mode::integrate, smallCameras(16).front()), without = with;
  without.mesh = {};
  const auto bricks = valueBricks(grid, with);
  RayRenderer renderer(*bricks, with);
  for (const ResolvedScene& scene : {without, with, without}) {
    renderer.setScene(scene);
    CHECK(maxDifference(renderer.render().colour, RayRenderer(*bricks, scene).render().colour) == 0);
  }
  CHECK_THROWS_WITH(ShearWarpRenderer(*bricks, with),
                    "mesh: a scene with one is not rendered by the technique shear-warp but by rays");
  ReferenceOptions options;
  options.integrator = Integrator::monteCarlo;
  CHECK_THROWS_WITH(renderReference(grid, with, options),
                    Contains("mesh: a scene with one is integrated by quadrature"));
  with.shading.light = ShadingLight::sources;
  CHECK_THROWS_WITH(renderer.setScene(with), Contains("shading.light: the scene has no directional source"));
}
