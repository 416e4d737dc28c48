// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/grid_world.h"

#include <catch2/catch.hpp>

#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Contains;

namespace {

openvdb::FloatGrid::Ptr placedGrid(const char* space, const char* unit) {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create();
  grid->tree().setValue({1, 2, 3}, 5);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(2.0));
  grid->transform().postTranslate({10, 20, 30});
  if (*space) grid->insertMeta("space", openvdb::StringMetadata(space));
  if (*unit) grid->insertMeta("length_unit", openvdb::StringMetadata(unit));
  return grid;
}

}  // namespace

TEST_CASE("A grid that is brought to another world shares its voxels", "[grid][world]") {
  const openvdb::FloatGrid::ConstPtr grid = placedGrid("LPS", "mm");
  std::vector<std::string> notes;
  const auto ras = inWorld(grid, {"RAS", "um", "that of x"}, notes);
  CHECK(ras->indexToWorld(openvdb::Coord(1, 2, 3)) == openvdb::Vec3d(-12000, -24000, 36000));
  CHECK(ras->treePtr() == grid->treePtr());
  CHECK(ras->metaValue<std::string>("space") == "RAS");
  CHECK(ras->metaValue<std::string>("length_unit") == "um");
  CHECK(notes.size() == 2);
  CHECK(grid->indexToWorld(openvdb::Coord(1, 2, 3)) == openvdb::Vec3d(12, 24, 36));
  CHECK(inWorld(grid, {"LPS", "mm", {}}, notes) == grid);
  CHECK(inWorld(placedGrid("", ""), {"LPS", "mm", {}}, notes)->metaCount() == placedGrid("", "")->metaCount());
  CHECK(notes.size() == 2);
}

TEST_CASE("The space of a grid is turned, or taken for the one that is asked for", "[grid][world]") {
  std::vector<std::string> notes;
  const auto turned = inSpace(placedGrid("RAS", ""), "LPS", notes);
  CHECK(turned->indexToWorld(openvdb::Coord(0)) == openvdb::Vec3d(-10, -20, 30));
  CHECK_THAT(notes.at(0), Contains("RAS to LPS"));
  const auto taken = inSpace(placedGrid("", ""), "LPS", notes);
  CHECK(taken->indexToWorld(openvdb::Coord(0)) == openvdb::Vec3d(10, 20, 30));
  CHECK(taken->metaValue<std::string>("space") == "LPS");
  CHECK_THAT(notes.at(1), Contains("taken for LPS"));
  CHECK_THROWS_WITH(inSpace(placedGrid("RAS", ""), "LLL", notes), Contains("three letters") && Contains("LLL"));
}
