// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/usual_value.h"

#include <catch2/catch.hpp>
#include <map>

#include "umbrick/core/random.h"

using namespace umbrick;

namespace {

// A grid of 40^3 voxels, a share of which is 3 and the rest one of a few other values, in leaves and a tile.
openvdb::FloatGrid::Ptr mixed(double share, std::uint64_t seed) {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(-1);
  Random random(seed);
  auto access = grid->getAccessor();
  for (int z = 0; z < 40; ++z)
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x) {
        const bool usual = random.uniform() < share;
        access.setValue({x, y, z}, usual ? 3.0f : static_cast<float>(4 + int(random.uniform() * 5)));
      }
  grid->tree().addTile(1, {64, 0, 0}, 4, true);  // 512 voxels
  return grid;
}

}  // namespace

TEST_CASE("The value that more than half of the active voxels have is found, with its number", "[grid]") {
  for (const double share : {0.1, 0.3, 0.45, 0.49, 0.51, 0.55, 0.7, 1.0}) {
    CAPTURE(share);
    const auto grid = mixed(share, 7);
    std::map<float, std::uint64_t> counts;
    for (auto value = grid->cbeginValueOn(); value; ++value) counts[*value] += value.getVoxelCount();
    const auto found = usualValue(*grid);
    CHECK(found.has_value() == (2 * counts[3] > grid->activeVoxelCount()));
    if (!found) continue;
    CHECK(found->value == 3);
    CHECK(found->voxels == counts[3]);
  }
}

TEST_CASE("A grid of one tile has its value, and one of nothing has none", "[grid]") {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create();
  CHECK(!usualValue(*grid));
  CHECK(!usualBorder(*grid));
  grid->fill(openvdb::CoordBBox({0, 0, 0}, {127, 127, 127}), 2);
  REQUIRE(usualValue(*grid));
  CHECK(usualValue(*grid)->voxels == 128 * 128 * 128);
  CHECK(usualBorder(*grid) == 2.0f);
}

TEST_CASE("The usual value of the border is that of the faces, not of what lies within, if there is one", "[grid]") {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create();
  grid->denseFill(openvdb::CoordBBox({-5, 0, 3}, {44, 49, 42}), -1000, true);
  grid->denseFill(openvdb::CoordBBox({-4, 1, 4}, {43, 48, 41}), 50, true);
  CHECK(usualBorder(*grid) == -1000.0f);
  Random random(3);
  for (auto voxel = grid->beginValueOn(); voxel; ++voxel) voxel.setValue(static_cast<float>(random.uniform()));
  CHECK(!usualBorder(*grid));
}

TEST_CASE("A large grid has its usual value too, and noise has none", "[grid]") {
  openvdb::initialize();
  for (const double share : {0.3, 0.6}) {
    auto grid = openvdb::FloatGrid::create(-1);
    Random random(21);
    auto access = grid->getAccessor();
    for (int z = 0; z < 136; ++z)
      for (int y = 0; y < 136; ++y)
        for (int x = 0; x < 136; ++x)
          access.setValue({x, y, z}, random.uniform() < share ? 3.0f : static_cast<float>(random.uniform()));
    REQUIRE(grid->tree().leafCount() > 4096);
    const auto found = usualValue(*grid);
    CHECK(found.has_value() == (share > 0.5));
    if (found) CHECK(double(found->voxels) == Approx(share * 136 * 136 * 136).epsilon(0.01));
  }
}
