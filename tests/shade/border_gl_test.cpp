// Slabs reach half their thickness beyond the voxels that their middle lies between: what lies at the border of a
// volume must be as whole as what lies inside of it.
// SPDX-License-Identifier: Apache-2.0
#include <openvdb/openvdb.h>

#include <set>

#include "shade/hard_case.h"

using namespace umbrick;

namespace {

// Returns the same volume with room around it: two more active voxels of empty space, far from it.
ScalarGrid padded(const ScalarGrid& grid) {
  ScalarGrid result = grid;
  const auto copy = grid.grid->deepCopy();
  copy->tree().setValueOn(openvdb::Coord(-40), copy->background());
  copy->tree().setValueOn(openvdb::Coord(80), copy->background());
  result.grid = copy;
  return result;
}

// Returns a sheet two voxels thick, the last of its voxels at `last` along z; and, for gradients, blobs before it.
ScalarGrid sheetAt(int last) {
  return makeFilled(glm::ivec3(18, 18, 12), {0, 0, last - 11}, [](const glm::ivec3& i) {
    return i.z >= 10 ? 1.0 : 0.5 * coneAt(i, {{9, 9, 3, 4}});
  });
}

ResolvedScene sheetScene(double spacing, int last, double fromAbove) {
  ResolvedScene scene =
      plainScene(ramp(1.5), orthographicCamera({8, 7, last + fromAbove}, {8.5, 8.5, last}, 14, 16), spacing);
  scene.sampling.segments = std::max(1, std::min(8, static_cast<int>(std::ceil(spacing / 0.625))));
  return scene;
}

}  // namespace

TEST_CASE("A sheet at the border is whole at every residue of the brick edge, bricked and not", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (int last = 13; last < 21; ++last)
    for (const double spacing : {0.5, 1.25, 2.5, 5.0})  // of slabs as qualities make them
      for (const double fromAbove : {31.3, -29.1}) {
        INFO("last voxel at " << last << ", slabs of " << spacing << ", seen from " << fromAbove);
        const ScalarGrid grid = sheetAt(last);
        ResolvedScene scene = sheetScene(spacing, last, fromAbove);
        scene.bricks.interior = 8;
        const Image whole = renderGrid(*context, padded(grid), scene).colour;
        CHECK(largestAlpha(whole) > 0.5);
        CHECK(maxDifference(renderGrid(*context, grid, scene).colour, whole) < 1e-5);
        BrickOptions options;
        options.apron = requiredApron(scene, grid.indexToWorld());
        const auto unbricked = unbrickedGrid(grid, options);
        CHECK(maxDifference(renderPicture(*context, *unbricked, scene).colour, whole) < 1e-5);
      }
}

TEST_CASE("A visible background fills the same box for slices and reference", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled(glm::ivec3(13, 10, 11), {3, -2, 5}, [](const glm::ivec3& i) {
    return coneAt(i, {{6, 5, 5, 4}});
  });
  const Medium fog{{0.4, 0.6, 0.9}, 0.03}, dense{kAlbedo, 0.5};
  const TransferFunction oneD({{0, fog}, {1, dense}});
  const TransferFunction twoD({0, 1}, {0, 0.2}, {fog, dense, fog, dense});
  for (const TransferFunction& transfer : {oneD, twoD})
    for (const double spacing : {0.5, 4.0}) {
      ResolvedScene scene = plainScene(transfer, perspectiveCamera({30, 12, 38}, {9, 3, 10}, 0.7, 24), spacing);
      scene.sampling.segments = spacing > 1 ? 8 : 1;
      scene.bricks.interior = 8;
      INFO("2D " << transfer.is2d() << ", spacing " << spacing);
      const Image exact = renderReference(grid, scene).colour;
      CHECK(largestAlpha(exact) > 0.3);
      CHECK(rmsDifference(renderGrid(*context, grid, scene).colour, exact) < 1e-3);
    }
}

TEST_CASE("Segments and cut slabs read no voxel beyond the apron, whatever the quadrature", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled(glm::ivec3(32), glm::ivec3(0), blobs);
  for (const Quadrature quadrature : {Quadrature::preintegrated, Quadrature::midpoint})
    for (const int segments : {1, 3, 8})
      for (const bool clipped : {false, true}) {
        ResolvedScene scene = plainScene(ramp(0.8), blobCameras()[1], 5);
        scene.sampling.quadrature = quadrature;
        scene.sampling.segments = segments;
        scene.bricks.interior = 8;
        if (clipped) scene.clipPlanes = {{0.3, -0.5, -1, 18.2}};
        INFO("midpoint " << (quadrature == Quadrature::midpoint) << ", segments " << segments << ", clipped "
                         << clipped);
        BrickOptions options;
        options.apron = requiredApron(scene, grid.indexToWorld());
        const Image bricked = renderGrid(*context, grid, scene).colour;
        // Places in textures are rounded differently: by about 1e-6 voxels, along rays that meet some fifty slabs.
        CHECK(maxDifference(bricked, renderPicture(*context, *unbrickedGrid(grid, options), scene).colour) < 1e-4);
        // Bricks with a narrower apron are refused.
        options.interior = 8;
        options.apron -= 1;
        CHECK_THROWS_AS(renderPicture(*context, *brickGrid(grid, options), scene), InvalidArgument);
      }
}
