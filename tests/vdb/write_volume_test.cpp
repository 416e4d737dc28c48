// Grids written in other formats, read back by the readers of those formats.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/vdb/write_volume.h"

#include <nanovdb/util/IO.h>

#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "support/files.h"
#include "support/read_volume.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/ingest/open_volume.h"
#include "umbrick/vdb/read_grid.h"

using namespace umbrick;
using Catch::Contains;
using openvdb::Coord;

namespace {

enum class Values { small, negative, fractions };

// A grid with scattered voxels and a tile at negative and positive indices, which is turned, stretched and moved.
openvdb::FloatGrid::Ptr turnedGrid(Values values, double mirror = 1) {
  auto grid = openvdb::FloatGrid::create(3);
  grid->setName("turned");
  std::mt19937 random(5);
  for (int i = 0; i < 300; ++i) {
    const Coord at(int(random() % 21) - 10, int(random() % 13) - 5, int(random() % 27) - 9);
    const float value = float(random() % 200);
    grid->tree().setValue(at, values == Values::small      ? value
                              : values == Values::negative ? value - 100
                                                           : value + 0.25f);
  }
  grid->tree().addTile(1, Coord(0, 0, 8), 7, true);
  openvdb::Mat4d map = openvdb::Mat4d::identity();
  map.preRotate(openvdb::math::X_AXIS, 0.3);
  map.preRotate(openvdb::math::Z_AXIS, -1.1);
  map.preScale(openvdb::Vec3d(0.7, 1.3, 2.9 * mirror));
  map.postTranslate(openvdb::Vec3d(-1234.5, 17.25, 1 / 3.0));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(map));
  return grid;
}

// Compares voxels and their places, one by one, with the grid.
void checkReadBack(const std::filesystem::path& path, const openvdb::FloatGrid& grid, const DenseBox& box) {
  const auto source = openVolume(path);
  CHECK(source->info().dims == box.dims);
  CHECK(source->info().type == box.type);
  const std::vector<float> voxels = readVolume(*source);
  const glm::dmat4& place = source->info().indexToWorld;
  double worst = 0;
  std::size_t different = 0, i = 0;
  for (int z = 0; z < box.dims.z; ++z)
    for (int y = 0; y < box.dims.y; ++y)
      for (int x = 0; x < box.dims.x; ++x) {
        const Coord at(x + int(box.first.x), y + int(box.first.y), z + int(box.first.z));
        different += voxels[i++] != grid.tree().getValue(at);
        const openvdb::Vec3d expected = grid.indexToWorld(at);
        const glm::dvec4 found = place * glm::dvec4(x, y, z, 1);
        for (int axis = 0; axis < 3; ++axis) worst = std::max(worst, std::abs(found[axis] - expected[axis]));
      }
  CHECK(different == 0);
  CHECK(worst < 1e-12 * 1300);  // world coordinates reach 1300: a few roundings of them
}

}  // namespace

TEST_CASE("A turned grid comes back from .nrrd and .mhd with its values and its place", "[grid]") {
  const TemporaryFolder folder;
  for (const char* name : {"v.nrrd", "v.mhd"})
    for (const double mirror : {1.0, -1.0})
      for (const auto& [values, asked, expected] :
           {std::tuple(Values::small, VoxelType::u8, VoxelType::u8),
            std::tuple(Values::small, VoxelType::i8, VoxelType::f32),  // values up to 199
            std::tuple(Values::negative, VoxelType::i8, VoxelType::i8),
            std::tuple(Values::negative, VoxelType::u16, VoxelType::f32),
            std::tuple(Values::negative, VoxelType::i16, VoxelType::i16),
            std::tuple(Values::small, VoxelType::u16, VoxelType::u16),
            std::tuple(Values::small, VoxelType::u32, VoxelType::u32),
            std::tuple(Values::negative, VoxelType::i32, VoxelType::i32),
            std::tuple(Values::fractions, VoxelType::u16, VoxelType::f32),
            std::tuple(Values::small, VoxelType::f64, VoxelType::f32)}) {
        CAPTURE(name, mirror, int(values), voxelTypeName(asked));
        const auto grid = turnedGrid(values, mirror);
        DenseOptions options;
        options.type = asked;
        const DenseBox box = writeDense(folder.path() / name, *grid, options);
        CHECK(box.type == expected);
        checkReadBack(folder.path() / name, *grid, box);
      }
}

TEST_CASE("NanoVDB holds the same voxels at the same place", "[grid]") {
  const TemporaryFolder folder;
  const auto grid = turnedGrid(Values::fractions), other = turnedGrid(Values::small);
  grid->setName("fine");
  other->setName("other");
  writeNanoVdb(folder.path() / "v.nvdb", {grid, other});
  const auto handles = nanovdb::io::readGrids((folder.path() / "v.nvdb").string());
  REQUIRE(handles.size() == 2);
  const auto* nano = handles[0].grid<float>();
  REQUIRE(nano);
  CHECK(std::string(nano->gridName()) == "fine");
  CHECK(nano->activeVoxelCount() == grid->activeVoxelCount());
  CHECK(handles[1].grid<float>()->activeVoxelCount() == other->activeVoxelCount());
  const auto access = nano->getAccessor();
  std::size_t different = 0;
  for (int z = -12; z < 20; ++z)
    for (int y = -12; y < 20; ++y)
      for (int x = -12; x < 20; ++x) different += access.getValue({x, y, z}) != grid->tree().getValue({x, y, z});
  CHECK(different == 0);
  const nanovdb::Vec3d found = nano->indexToWorld(nanovdb::Vec3d(-3, 5, 11));
  const openvdb::Vec3d expected = grid->indexToWorld(Coord(-3, 5, 11));
  for (int axis = 0; axis < 3; ++axis) CHECK(std::abs(found[axis] - expected[axis]) < 1e-12 * 1300);
}

TEST_CASE("What cannot be a dense box is refused, and nothing is written", "[grid]") {
  const TemporaryFolder folder;
  const auto check = [&](const openvdb::FloatGrid& grid, const char* name, std::int64_t maxBytes,
                         const std::string& message) {
    DenseOptions options;
    options.maxBytes = maxBytes;
    CHECK_THROWS_WITH(writeDense(folder.path() / name, grid, options), Contains(name) && Contains(message));
    CHECK(std::filesystem::is_empty(folder.path()));
  };
  const auto far = openvdb::FloatGrid::create();
  check(*far, "v.nrrd", 1000, "expected a grid with active voxels, found none");
  far->tree().setValue(Coord(-2147483647), 1);
  far->tree().setValue(Coord(2147483647), 1);
  check(*far, "v.mhd", 1000, "expected at most 1000 bytes, found 4294967295 x 4294967295 x 4294967295 f32");
  check(*turnedGrid(Values::small), "v.nrrd", 1000, "expected at most 1000 bytes, found 21 x 13 x 27 f32 = 29484");
  check(*turnedGrid(Values::small), "v.tif", 1 << 30, ".nrrd or .mhd");
}

TEST_CASE("Every codec of a .vdb holds the same grid", "[grid]") {
  const TemporaryFolder folder;
  const auto grid = turnedGrid(Values::fractions);
  for (const VdbCodec codec : {VdbCodec::blosc, VdbCodec::zip, VdbCodec::none}) {
    writeGrids(folder.path() / "v.vdb", {grid}, {}, codec);
    const ScalarGrid back = readScalarGridAnyTransform(folder.path() / "v.vdb", "turned");
    std::size_t different = 0;
    for (auto value = grid->cbeginValueOn(); value; ++value)
      different += back.grid->tree().getValue(value.getCoord()) != *value;
    CHECK(different == 0);
    CHECK(back.grid->activeVoxelCount() == grid->activeVoxelCount());
  }
}
