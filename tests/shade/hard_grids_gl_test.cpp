// Hard cases of what a grid holds and where its voxels are, against the reference. Tested elsewhere: volumes without
// bricks (bad_input_gl_test); a visible background against closed forms (emission_gl_test); that bricks change nothing
// far from the origin, in level sets and where the background is seen (check); what a program says of grids that cannot
// be rendered (tools: hard_volumes_test).
// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <string>

#include "shade/hard_case.h"
#include "support/complaint.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/float_grid.h"

using namespace umbrick;
using Catch::Contains;

namespace {

ScalarGrid twoBlocks(const glm::ivec3& first, const glm::ivec3& second, int edge) {
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0);
  for (const glm::ivec3& at : {first, second})
    grid->fill(openvdb::CoordBBox::createCube(openvdb::Coord(at.x, at.y, at.z), edge), 1.0f);
  return makeGrid(grid);
}

}  // namespace

TEST_CASE("A grid without voxels is an empty picture for renderer and reference", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid empty = makeVoxels({});
  for (const Model model : {Model::emission, Model::cone}) {
    ResolvedScene scene = plainScene(ramp(1), orthographicCamera({0, 0, 9}, {0, 0, 0}, 10, 8), 0.5);
    scene.model = model;
    const Picture picture = renderGrid(*context, empty, scene);
    CHECK(picture.stats.bricks == 0);
    CHECK(maxDifference(picture.colour, Image(8, 8)) == 0);
    CHECK(maxDifference(renderReference(empty, scene).colour, Image(8, 8)) == 0);
  }
}

// A voxel is a tent of base 2 along each axis: sigma_t = product of (1 - |x|).
TEST_CASE("One voxel is the tent that trilinear interpolation makes of it", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid voxel = makeVoxels({{{3, -2, 7}, 1.0f}});
  const Box around{glm::dvec3(2, -3, 6), glm::dvec3(4, -1, 8)};
  checkViewsAgainstReference(*context, voxel, ramp(1.5), around, 0.25);
  // The ray goes straight through its middle. The sum of a tent at equal distances of half its base, or of that over a
  // whole number, is its area, so that a slab is integrated exactly, except for the table and roundings.
  Camera camera = orthographicCamera({3, -2, 20}, {3, -2, 0}, 0.01, 1);
  camera.up = {0, 1, 0};
  for (const double spacing : {0.25, 0.5, 1.0}) {
    const ResolvedScene scene = plainScene(ramp(1.5), camera, spacing);
    CHECK(renderGrid(*context, voxel, scene).colour.at(0, 0)[3] == Approx(-std::expm1(-1.5)).epsilon(1e-4));
  }
}

TEST_CASE("Tiles without leaves are voxels like any other", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const openvdb::FloatGrid::Ptr tiles = openvdb::FloatGrid::create(0);
  tiles->tree().addTile(1, openvdb::Coord(0, 0, 0), 1, true);
  tiles->tree().addTile(1, openvdb::Coord(8, 0, 0), 0.5f, false);  // inactive, but not background
  tiles->tree().addTile(1, openvdb::Coord(-16, 8, 16), 0.7f, true);
  REQUIRE(tiles->tree().leafCount() == 0);
  const Box bounds{glm::dvec3(-17, -1, -1), glm::dvec3(16, 16, 24)};
  checkViewsAgainstReference(*context, makeGrid(tiles), ramp(0.2), bounds, 0.5);
  // A tile of 128^3 voxels is 512 bricks of one value, which share a slot.
  const openvdb::FloatGrid::Ptr large = openvdb::FloatGrid::create(0);
  large->tree().addTile(2, openvdb::Coord(0, 0, 0), 1, true);
  checkViewsAgainstReference(*context, makeGrid(large), ramp(0.01), {glm::dvec3(0), glm::dvec3(127)}, 1);
}

TEST_CASE("A level set is filled with its inside background", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid ball = makeSphereLevelSet(12, 1, {3, 4, -5});
  REQUIRE(ball.grid->tree().getValue(openvdb::Coord(3, 4, -5)) < 0);
  REQUIRE_FALSE(ball.grid->tree().isValueOn(openvdb::Coord(3, 4, -5)));
  const Box bounds{glm::dvec3(-10, -9, -18), glm::dvec3(16, 17, 8)};
  checkViewsAgainstReference(*context, ball, ramp(0.1, 0, -2), bounds, 0.5);
  // On a ray through the centre, sigma_t rises over two voxels on either side to its full value.
  Camera camera = orthographicCamera({3, 4, 30}, {3, 4, -5}, 0.01, 1);
  camera.up = {0, 1, 0};
  const ResolvedScene scene = plainScene(ramp(0.1, 0, -2), camera, 0.5);
  // The ray is 24 units long inside, less 2 for the two ramps. The narrow band is a distance to 1e-2 of a
  // voxel between voxels.
  CHECK(renderGrid(*context, ball, scene).colour.at(0, 0)[3] == Approx(-std::expm1(-0.1 * 22)).margin(2e-3));
}

TEST_CASE("A background other than 0 is what the transfer function makes of it", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid soft = makeFilled(
      {20, 18, 16}, {-9, 4, 2}, [](const glm::ivec3& p) { return 5 - 0.2 * p.x * std::sin(0.3 * p.y); }, 5);
  const Box bounds{glm::dvec3(-10, 3, 1), glm::dvec3(11, 22, 18)};
  checkViewsAgainstReference(*context, soft, ramp(0.1, 5, 1), bounds, 0.5);  // the background is not seen
  checkViewsAgainstReference(*context, soft, ramp(0.1, 1, 5), bounds, 0.5);  // thick fog in the domain
}

TEST_CASE("Negative indices are like others", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const glm::ivec3 moved(-1027, -500, -77);  // also moves the voxels relative to the lattice of bricks
  const ScalarGrid here = makeNoise({11, 9, 10}), there = makeNoise({11, 9, 10}, moved);
  const TransferFunction transfer = ramp(0.4);
  checkViewsAgainstReference(*context, there, transfer, {glm::dvec3(moved), glm::dvec3(moved + 10)}, 0.5);
  for (const Model model : {Model::emission, Model::cone}) {
    ResolvedScene scene = plainScene(transfer, perspectiveCamera({25, 30, 40}, {5, 5, 5}, 0.5, 32), 0.5);
    scene.model = model;
    const Image image = renderGrid(*context, here, scene).colour;
    scene.camera.eye += glm::dvec3(moved);
    scene.camera.lookAt += glm::dvec3(moved);
    // Whole numbers move without rounding. Bricks lie elsewhere, so that coordinates in the atlas round differently: by
    // 6e-8 of some 50 texels, where values differ by up to 1 from texel to texel, on each of some 40 slabs.
    CHECK(maxDifference(image, renderGrid(*context, there, scene).colour) < 40 * 0.4 * 0.5 * 3e-6);
  }
}

// The voxels are 2e4 apart along each axis, with 8e12 voxels in the box, of which 1024 are active.
TEST_CASE("Voxels far apart are rendered without what lies between them", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const glm::ivec3 far(20'000, -20'000, 20'000);
  const ScalarGrid both = twoBlocks({0, 0, 0}, far, 8), one = twoBlocks({0, 0, 0}, {0, 0, 0}, 8);
  const TransferFunction transfer = ramp(0.2);
  const auto volume = bricksFor(both, plainScene(transfer, orthographicCamera({4, 40, 4}, {4, 4, 4.1}, 14, 24), 0.5));
  CHECK(volume->bricks.size() <= 16);
  for (const Model model : {Model::emission, Model::cone}) {
    // The other one is beside the image, so it adds neither light nor shadow.
    ResolvedScene scene = plainScene(transfer, orthographicCamera({4, 40, 4}, {4, 4, 4.1}, 14, 24), 0.5);
    scene.model = model;
    CHECK(maxDifference(renderGrid(*context, both, scene).colour, renderGrid(*context, one, scene).colour) == 0);
  }
  // The voxels lie one behind the other, with 35 000 empty voxels between them.
  ResolvedScene scene = plainScene(transfer, perspectiveCamera({-30, 36, -25}, glm::dvec3(far), 0.5, 24), 0.5);
  scene.sampling.spacing = 0.5;
  checkAgainstReference(*context, both, scene);
  // If the space between were not empty, it would be 2e9 bricks.
  scene.transfer = ramp(0.2, -1, 1);
  CHECK_THAT(complaint<InvalidArgument>([&] { renderGrid(*context, both, scene); }),
             Contains("background") && Contains("more than the limit"));
}

TEST_CASE("Voxels near the limits of 32-bit indices are rendered or refused", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
  const TransferFunction transfer = ramp(0.4);
  // The voxels lie in front of the last 4096, a node of OpenVDB's tree that has no neighbour.
  for (const glm::ivec3& at :
       {glm::ivec3(most - 4200), glm::ivec3(-most + 4200), glm::ivec3(most - 4200, 0, -most + 64)}) {
    INFO("at " << at.x << ' ' << at.y << ' ' << at.z);
    const ScalarGrid grid = makeNoise({8, 8, 8}, at);
    checkViewsAgainstReference(*context, grid, transfer, {glm::dvec3(at) - 1.0, glm::dvec3(at) + 8.0}, 0.5, 24);
  }
  // Bricks reach nearly to the limit. The picture is the same as at the origin, except for the camera's coordinates,
  // which have steps of 5e-7 at 2e9.
  const glm::ivec3 moved(most - 127, 16, -most + 128);
  ResolvedScene origin = plainScene(transfer, orthographicCamera({20, 25, 30}, {4, 4, 4}, 16, 24), 0.5), limit = origin;
  limit.camera.eye += glm::dvec3(moved);
  limit.camera.lookAt += glm::dvec3(moved);
  CHECK(maxDifference(renderGrid(*context, makeNoise({8, 8, 8}), origin).colour,
                      renderGrid(*context, makeNoise({8, 8, 8}, moved), limit).colour) < 2e-5);
  // The apron of the last brick would be beyond the limits.
  const ScalarGrid last = makeVoxels({{glm::ivec3(most, 0, 0), 1.0f}});
  const ResolvedScene scene =
      plainScene(transfer, orthographicCamera(glm::dvec3(most, 0, 9), glm::dvec3(most, 0, 0), 10, 8), 0.5);
  CHECK_THAT(complaint<InvalidArgument>([&] { renderGrid(*context, last, scene); }),
             Contains("32-bit indices") && Contains("2147483648"));
}
