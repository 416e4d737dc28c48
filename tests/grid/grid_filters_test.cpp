// Boxes and masks of grids, voxel by voxel.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/grid_filters.h"

#include <catch2/catch.hpp>

#include "support/read_volume.h"
#include "support/test_grids.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Contains;
using openvdb::Coord;
using openvdb::CoordBBox;

namespace {

// A grid with leaves, with tiles of 8^3 and 128^3 voxels, and with a background.
openvdb::FloatGrid::Ptr mixedGrid() {
  auto grid = openvdb::FloatGrid::create(0.5f);
  grid->setName("mixed");
  TestRandom random(3);
  for (int i = 0; i < 400; ++i)
    grid->tree().setValue(Coord(random.below(60) - 20, random.below(30), random.below(40)), float(random.uniform()));
  grid->tree().addTile(1, Coord(0, 32, 0), 7, true);
  grid->tree().addTile(2, Coord(0, 128, 0), 8, true);
  return grid;
}

// Checks whether each voxel in and around the grid has the value and the state that `expected` says.
template <class Expected>
void checkVoxels(const openvdb::FloatGrid& grid, const openvdb::FloatGrid& before, const Expected& kept) {
  std::size_t different = 0;
  const auto now = grid.getConstAccessor(), then = before.getConstAccessor();
  for (auto at = CoordBBox(Coord(-30, -2, -2), Coord(45, 140, 45)).begin(); at; ++at) {
    const bool on = then.isValueOn(*at) && kept(*at);
    different += now.isValueOn(*at) != on || now.getValue(*at) != (on ? then.getValue(*at) : before.background());
  }
  CHECK(different == 0);
}

}  // namespace

TEST_CASE("A box keeps the voxels in it, and all others become background", "[grid]") {
  const auto before = mixedGrid();
  for (const IndexBox& box : {IndexBox{{-11, 3, 2}, {13, 36, 33}}, IndexBox{{1, 34, 3}, {4, 130, 5}}}) {
    const auto grid = before->deepCopy();
    cropGrid(*grid, box);
    checkVoxels(*grid, *before, [&](const Coord& at) {
      return at.x() >= box.min.x && at.x() <= box.max.x && at.y() >= box.min.y && at.y() <= box.max.y &&
             at.z() >= box.min.z && at.z() <= box.max.z;
    });
    CHECK(grid->getName() == "mixed");
  }
  CHECK_THROWS_WITH(cropGrid(*before->deepCopy(), {{900, 0, 0}, {910, 9, 9}}),
                    Contains("mixed") && Contains("(127 255 127), found (900 0 0) to (910 9 9)"));
  CHECK_THROWS_AS(cropGrid(*before->deepCopy(), {{3, 0, 0}, {2, 9, 9}}), InvalidArgument);
}

TEST_CASE("A mask keeps the voxels where it is active and not 0", "[grid]") {
  const auto before = mixedGrid(), mask = openvdb::FloatGrid::create(0);
  TestRandom random(4);
  for (int i = 0; i < 30000; ++i)
    mask->tree().setValue(Coord(random.below(60) - 20, random.below(40), random.below(40)), float(random.below(3)));
  mask->tree().addTile(1, Coord(0, 128, 0), 1, true);
  mask->tree().addTile(1, Coord(8, 128, 0), 0, true);
  const auto grid = before->deepCopy();
  const std::uint64_t leftOut = maskGrid(*grid, *mask);
  CHECK(leftOut == before->activeVoxelCount() - grid->activeVoxelCount());
  CHECK(grid->activeVoxelCount() > 512);
  checkVoxels(*grid, *before,
              [&](const Coord& at) { return mask->tree().isValueOn(at) && mask->tree().getValue(at) != 0; });
}

TEST_CASE("A mask at another place or with a background, and level sets, are refused", "[grid]") {
  const auto grid = mixedGrid(), mask = openvdb::FloatGrid::create(0), full = openvdb::FloatGrid::create(1);
  mask->setTransform(openvdb::math::Transform::createLinearTransform(1.01));
  CHECK_THROWS_WITH(maskGrid(*grid, *mask), Contains("position of voxel") && Contains("mixed"));
  CHECK_THROWS_WITH(maskGrid(*grid, *full), Contains("background: expected 0, found 1"));
  const auto sphere = makeSphereLevelSet().grid->deepCopy();
  CHECK_THROWS_WITH(maskGrid(*sphere, *mask), Contains("found a level set"));
  CHECK_THROWS_WITH(cropGrid(*sphere, {{0, 0, 0}, {9, 9, 9}}), Contains("found a level set"));
}

TEST_CASE("A grid read as a volume has its values at the same indices", "[grid]") {
  const auto grid = mixedGrid();
  const auto source = gridSource("mixed", grid, {20, 36, 11});
  const std::vector<float> voxels = readVolume(*source);
  std::size_t different = 0, i = 0;
  for (int z = 0; z < 11; ++z)
    for (int y = 0; y < 36; ++y)
      for (int x = 0; x < 20; ++x) different += voxels[i++] != grid->tree().getValue(Coord(x, y, z));
  CHECK(different == 0);
}
