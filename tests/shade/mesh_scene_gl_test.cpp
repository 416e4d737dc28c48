// A mesh in the volume, by rays on OpenGL: against a cut, rays on the CPU and the reference.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "support/gl_fixture.h"
#include "support/mesh_scenes.h"
#include "support/observed_order.h"
#include "sweep/value_picture.h"
#include "umbrick/core/error.h"
#include "umbrick/shade/ray_caster.h"
#include "umbrick/shade/slice_renderer.h"

using namespace umbrick;
using Catch::Contains;

namespace {

Picture castMesh(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene,
                 const AtlasLimits& limits = {}) {
  const auto volume = valueBricks(grid, scene);
  return RayCaster(context, *volume, scene, {}, limits).render();
}

}  // namespace

TEST_CASE("A wall shows on OpenGL of each mode what a clip plane leaves in front of it", "[shade][rays][mesh][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  for (const Mode mode : kAllModes) {
    CAPTURE(modeName(mode));
    const ResolvedScene scene = wallScene(mode);
    const Image walled = castMesh(*context, grid, scene).colour;
    const Image cut = castMesh(*context, grid, cutAtWall(scene)).colour;
    double worst = 0;
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 20; ++x)
        for (int c = 0; c < 3; ++c)
          worst = std::max(worst, std::abs(walled.at(x, y)[c] - overWall(scene, cut.at(x, y), c)));
    // Places along a ray are single precision, 1e-5 of a voxel or so.
    CHECK(worst < 1e-4);
  }
}

TEST_CASE("A scene with a mesh on OpenGL is that of the CPU in each mode", "[shade][rays][mesh][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  for (const Mode mode : kAllModes) {
    CAPTURE(modeName(mode));
    ResolvedScene scene = meshScene(mode, smallCameras(24).back());
    scene.background = glm::dvec3(0.1, 0.2, 0.5);
    const Picture ours = castMesh(*context, grid, scene);
    const Picture theirs = valuePicture(grid, scene, 4);
    // Of projections the number: where it is next to nothing a pixel may be clear or black.
    CHECK((traitsOf(mode).projection ? rmsDifference(layerOf(ours, "value"), layerOf(theirs, "value"))
                                     : rmsDifference(ours.colour, theirs.colour)) < 1e-3);
    AtlasLimits small;
    small.budgetBytes = ours.stats.textureBytes / 3;
    CHECK(maxDifference(castMesh(*context, grid, scene, small).colour, ours.colour) < 1e-4);
  }
}

TEST_CASE("The shadow of a mesh on OpenGL is that of the CPU", "[shade][rays][mesh][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  for (const Mode mode : {Mode::integrate, Mode::isosurface, Mode::hybrid}) {
    CAPTURE(modeName(mode));
    ResolvedScene scene = shadowScene(mode, smallCameras(16).back());
    CHECK(rmsDifference(castMesh(*context, grid, scene).colour, valuePicture(grid, scene, 4).colour) < 1e-3);
  }
  // Light is computed where meshes are known.
  const ResolvedScene scene = shadowScene(Mode::integrate, smallCameras(16).back());
  const auto volume = valueBricks(grid, scene);
  RenderOptions onGl;
  onGl.lightSweep = LightSweep::gl;
  const Picture picture = RayCaster(*context, *volume, scene, onGl).render();
  CHECK_FALSE(picture.stats.lightOnGl);
  CHECK_THAT(picture.stats.lightNote, Contains("mesh"));
  CHECK(maxDifference(picture.colour, castMesh(*context, grid, scene).colour) == 0);
}

TEST_CASE("A mesh comes and goes with a scene on OpenGL, and is refused by slices", "[shade][rays][mesh][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid();
  const ResolvedScene with = meshScene(Mode::integrate, smallCameras(16).front());
  ResolvedScene without = with;
  without.mesh = {};
  const auto bricks = valueBricks(grid, with);
  RayCaster renderer(*context, *bricks, with);
  for (const ResolvedScene& scene : {without, with, without}) {
    renderer.setScene(scene);
    CHECK(maxDifference(renderer.render().colour, RayCaster(*context, *bricks, scene).render().colour) == 0);
  }
  CHECK_THROWS_WITH(SliceRenderer(*context, *bricks, with),
                    Contains("mesh: a scene with one is not rendered by the technique slices but by rays"));
}
