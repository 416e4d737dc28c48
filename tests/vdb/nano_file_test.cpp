// SPDX-License-Identifier: Apache-2.0
#include <openvdb/tools/LevelSetSphere.h>

#define NANOVDB_USE_ZIP
#define NANOVDB_USE_BLOSC
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>

#include <catch2/catch.hpp>

#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/vdb/read_grid.h"
#include "umbrick/vdb/summary.h"

using namespace umbrick;
using Catch::Contains;

namespace {

// A sheared, mirrored grid with voxels, a tile and a background.
openvdb::FloatGrid::Ptr sample() {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(0.25f);
  grid->setName("density");
  grid->fill({{0, 0, 0}, {7, 7, 7}}, 3.0f);
  for (int i = -20; i < 40; i += 3) grid->tree().setValue({i, 2 * i, 5}, static_cast<float>(i));
  openvdb::Mat4d matrix(0.0, -0.5, 0.0, 0.0, 2.0, 0.5, 0.0, 0.0, 0.0, 0.0, 4.0, 0.0, 10.0, 20.0, 30.0, 1.0);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
  return grid;
}

struct NanoFile {
  TemporaryFolder folder;
  std::filesystem::path path = folder.path() / "v.nvdb";
  void write(nanovdb::io::Codec codec) const {
    nanovdb::io::writeGrid(path.string(), nanovdb::openToNanoVDB(*sample()), codec);
  }
};

}  // namespace

TEST_CASE("A NanoVDB file is the grid that it was made of, in every codec", "[grid]") {
  const NanoFile file;
  const auto expected = sample();
  for (const auto codec : {nanovdb::io::Codec::NONE, nanovdb::io::Codec::ZIP, nanovdb::io::Codec::BLOSC}) {
    file.write(codec);
    const ScalarGrid read = readScalarGrid(file.path);
    CHECK(read.name == "density");
    CHECK(read.grid->background() == 0.25f);
    CHECK(read.grid->tree().hasSameTopology(expected->tree()));
    for (auto voxel = expected->cbeginValueOn(); voxel; ++voxel)
      CHECK(read.grid->tree().getValue(voxel.getCoord()) == *voxel);
    for (const openvdb::Vec3d point : {openvdb::Vec3d(0, 0, 0), openvdb::Vec3d(1, 2, 3)})
      CHECK(read.grid->indexToWorld(point) == expected->indexToWorld(point));
  }
  CHECK(summariseFile(file.path).libraryVersion == "NanoVDB 32.4");
  CHECK(summariseFile(file.path).version == "32.4");
}

TEST_CASE("Broken NanoVDB files are refused and never crash", "[grid]") {
  const NanoFile file;
  for (const auto codec : {nanovdb::io::Codec::NONE, nanovdb::io::Codec::ZIP, nanovdb::io::Codec::BLOSC}) {
    file.write(codec);
    const std::string good = readBytes(file.path);
    for (std::size_t length = 0; length < good.size(); length += 1 + good.size() / 40) {
      writeBytes(file.path, good.substr(0, length));
      CHECK_THROWS_AS(readScalarGrid(file.path), IoError);
    }
  }
  file.write(nanovdb::io::Codec::NONE);
  const std::string good = readBytes(file.path);
  const auto refused = [&](std::size_t at, const std::string& bytes, const std::string& message) {
    std::string bad = good;
    writeBytes(file.path, bad.replace(at, bytes.size(), bytes));
    CHECK_THROWS_AS(readScalarGrid(file.path), IoError);
    CHECK_THROWS_WITH(readScalarGrid(file.path), Contains(message) && Contains(file.path.string()));
  };
  refused(14, "\x09", "codec: expected 0 to 2 (none, ZIP or Blosc), found 9");
  refused(8, std::string(4, '\0'), "NanoVDB version: expected 32, found 0");
  // The offset of the root stands behind the header of 16 bytes, the table row of 176, the name of 8 and
  // the grid of 672.
  refused(16 + 176 + 8 + 672 + 24, std::string(8, '\x7f'), "nodes: expected each within the");
}
