// Tests what the programs say of volumes with voxels that are not finite, without voxels, and too large
// for one texture.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <string>

#include "support/gl_fixture.h"
#include "support/test_grids.h"
#include "tools/program.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/image/exr.h"
#include "umbrick/vdb/write_volume.h"

using namespace umbrick;
using Catch::Contains;

namespace {

const std::string kTransfer =
    "{\"points\": [{\"value\": 0, \"albedo\": [0.9, 0.5, 0.2], \"sigma_t\": 0},"
    " {\"value\": 1, \"albedo\": [0.9, 0.5, 0.2], \"sigma_t\": 0.3}]}";

void writeVolume(const TemporaryFolder& folder, const std::string& name, const openvdb::FloatGrid::Ptr& grid) {
  grid->setName("density");
  writeGrids(folder.path() / name, {grid});
}

Image pictureOf(const TemporaryFolder& folder, const std::string& name) {
  return readExr(folder.path() / name).layers.at(0).image;
}

long lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

}  // namespace

TEST_CASE("NaN and infinite voxels are counted in one line and render as background", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  writeBytes(folder.path() / "tf.json", kTransfer);
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const openvdb::FloatGrid::Ptr clean = makeDense({16, 16, 16}).grid->deepCopy(), dirty = clean->deepCopy();
  int bad = 0;
  for (int i = 0; i < 16; ++i)
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity}) {
      const openvdb::Coord at(i, (5 * i) % 16, (3 * bad++) % 16);
      clean->tree().setValue(at, 0.0f);
      dirty->tree().setValue(at, value);
    }
  // Some of the 48 places may be the same voxel.
  std::uint64_t count = 0;
  for (auto voxel = dirty->cbeginValueOn(); voxel; ++voxel) count += !std::isfinite(*voxel);
  REQUIRE(count > 30);
  writeVolume(folder, "clean.vdb", clean);
  writeVolume(folder, "dirty.vdb", dirty);
  for (const std::string command : {"render", "reference"})
    for (const std::string options : {" --up z --model emission", " --up z --model cone"}) {
      if (command == "reference" && options.ends_with("cone")) continue;  // the same grid, but slow
      CAPTURE(command, options);
      const std::string rest = " --tf tf.json --azimuth 20 --elevation 30 --size 24x24 --exr-pixel float" + options;
      const ProgramResult quiet = runProgram(folder, command + " clean.vdb -o clean.exr" + rest);
      CHECK(quiet.status == 0);
      CHECK(quiet.err.empty());
      const ProgramResult warned = runProgram(folder, command + " dirty.vdb -o dirty.exr" + rest);
      CHECK(warned.status == 0);
      CHECK(warned.out == "dirty.exr\n");
      CHECK(lines(warned.err) == 1);
      CHECK_THAT(warned.err, Contains("dirty.vdb: " + std::to_string(count) + " voxels are not finite"));
      const Image image = pictureOf(folder, "dirty.exr");
      CHECK(image.pixels == pictureOf(folder, "clean.exr").pixels);
      CHECK(*std::max_element(image.pixels.begin(), image.pixels.end()) > 0.3f);
    }
}

TEST_CASE("Volumes without voxels are refused in one line", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  writeBytes(folder.path() / "tf.json", kTransfer);
  writeVolume(folder, "empty.vdb", openvdb::FloatGrid::create(0));
  for (const std::string command : {"render", "reference"}) {
    const ProgramResult result = runProgram(folder, command + " empty.vdb --tf tf.json -o a.exr");
    CHECK(result.status == 1);
    CHECK(lines(result.err) == 1);
    CHECK_THAT(result.err, Contains("empty.vdb") && Contains("no active voxel"));
    CHECK_FALSE(std::filesystem::exists(folder.path() / "a.exr"));
  }
}

// Between the two voxels lie 2e12 others.
TEST_CASE("A volume too large for one texture is rendered in bricks and refused as one", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  writeBytes(folder.path() / "tf.json", kTransfer);
  writeVolume(folder, "far.vdb",
              makeVoxels({{glm::ivec3(0), 1.0f}, {glm::ivec3(20'000, 10'000, 10'000), 1.0f}}).grid->deepCopy());
  const std::string view =
      "far.vdb --tf tf.json --orthographic --eye 0 -9 0 --look-at 0 0 0 --view-height 4 --size 9x9 --model emission ";
  CHECK(runProgram(folder, "render " + view + "-o a.exr --exr-pixel float").status == 0);
  // The ray goes through the middle of a voxel's tent: 1 - exp(-0.3).
  CHECK(pictureOf(folder, "a.exr").at(4, 4)[3] == Approx(0.25918).epsilon(1e-3));
  const ProgramResult result = runProgram(folder, "render " + view + "-o b.exr --unbricked");
  CHECK(result.status == 1);
  CHECK(lines(result.err) == 1);
  CHECK_THAT(result.err, Contains("one brick of the whole grid") && Contains("2147483648"));
}
