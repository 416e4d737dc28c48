// NanoVDB files of few bits a value, and every kind of file read back before it takes its name.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "support/files.h"
#include "support/memory_source.h"
#include "support/temporary_folder.h"
#include "support/test_grids.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/verify.h"
#include "umbrick/vdb/read_back.h"
#include "umbrick/vdb/write_volume.h"

using namespace umbrick;
using Catch::Contains;
using openvdb::Coord;

namespace {

// A grid with noise, a leaf of one value, a tile, and a background that lies between the values.
openvdb::FloatGrid::Ptr noiseAndTile() {
  const auto grid = makeNoise(glm::ivec3(20, 19, 30), glm::ivec3(-3, 0, 5), 2).grid->deepCopy();
  grid->setName("noise");
  grid->tree().addTile(1, Coord(64, 0, 0), 0.3f, true);
  for (int i = 0; i < 512; ++i) grid->tree().setValue(Coord(80 + (i >> 6), i >> 3 & 7, i & 7), 0.7f);
  return grid;
}

struct StoredLoss {
  double max = 0, squares = 0, activeSquares = 0;
  bool halfSteps = true;  // no value is off by more than half a step between the extremes of its leaf
};

StoredLoss storedLoss(const openvdb::FloatGrid& grid, const openvdb::FloatGrid& stored, double steps) {
  StoredLoss plain;
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
    double low = 1e9, high = -1e9;
    for (openvdb::Index i = 0; i < 512; ++i) {
      low = std::min(low, double(leaf->getValue(i)));
      high = std::max(high, double(leaf->getValue(i)));
    }
    for (openvdb::Index i = 0; i < 512; ++i) {
      const double error =
          std::abs(double(leaf->getValue(i)) - double(stored.tree().getValue(leaf->offsetToGlobalCoord(i))));
      plain.max = std::max(plain.max, error);
      plain.squares += error * error;
      if (leaf->isValueOn(i)) plain.activeSquares += error * error;
      // Values are below 1: sums of floats round by less than 1e-6.
      if (error > 0.5 * (high - low) / steps + 1e-6) plain.halfSteps = false;
    }
  }
  return plain;
}

}  // namespace

TEST_CASE("Quantised values are off by half a step at most, and by what is stated", "[grid]") {
  const TemporaryFolder folder;
  const auto grid = noiseAndTile();
  const auto path = folder.path() / "v.nvdb";
  std::uintmax_t bytes = 0;
  for (const auto& [values, bits] :
       {std::pair(NanoValues::bits4, 4), std::pair(NanoValues::bits8, 8), std::pair(NanoValues::bits16, 16)}) {
    CAPTURE(bits);
    NanoOptions options;
    options.values = values;
    const QuantiseError stated = writeNanoVdb(path, {grid}, options).front();
    const auto back = readBack(path, *grid);
    const StoredLoss found = storedLoss(*grid, *back, std::exp2(bits) - 1);
    CHECK(found.halfSteps);
    CHECK(found.max == stated.max);
    CHECK(found.squares == Approx(stated.squares));
    CHECK(found.activeSquares == Approx(stated.activeSquares));
    CHECK(back->activeVoxelCount() == grid->activeVoxelCount());
    CHECK(back->tree().getValue(Coord(83, 2, 5)) == 0.7f);
    CHECK(back->tree().getValue(Coord(66, 2, 5)) == 0.3f);
    CHECK(std::filesystem::file_size(path) > bytes);
    bytes = std::filesystem::file_size(path);
  }
}

TEST_CASE("As few bits are used as keep the error that is asked for", "[grid]") {
  const TemporaryFolder folder;
  const auto grid = noiseAndTile();
  const auto path = folder.path() / "v.nvdb";
  NanoOptions options;
  options.values = NanoValues::adaptive;
  std::uintmax_t bytes = 0;
  for (const float maxError : {0.3f, 0.04f, 0.003f, 1e-4f}) {
    CAPTURE(maxError);
    options.maxError = maxError;
    const QuantiseError stated = writeNanoVdb(path, {grid, grid}, options).back();
    CHECK(stated.max <= double(maxError));
    CHECK(storedLoss(*grid, *readBack(path, *grid, 1), 1).max == stated.max);
    CHECK(std::filesystem::file_size(path) > bytes);
    bytes = std::filesystem::file_size(path);
  }
  options.maxError = 1e-7f;
  CHECK_THROWS_WITH(
      writeNanoVdb(path, {grid}, options),
      Contains("v.nvdb: grid \"noise\": 16 bits a value are too few: expected a maximum error of at most 1"));
  CHECK(std::filesystem::file_size(path) == bytes);
  // In grids with tiles alone, or with nothing, there is nothing to quantise.
  const auto empty = openvdb::FloatGrid::create(2), tiles = makeTiles().grid->deepCopy();
  for (const auto& one : {empty, tiles}) {
    CHECK(writeNanoVdb(path, {one}, options).front().max == 0);
    CHECK(readBack(path, *one)->activeVoxelCount() == one->activeVoxelCount());
  }
}

TEST_CASE("Values too far apart for a step of 32 bits are refused, and nothing is written", "[grid]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "v.nvdb";
  const auto grid = noiseAndTile();
  grid->tree().setValue(Coord(3, 3, 8), -3e38f);
  grid->tree().setValue(Coord(4, 3, 8), 3e38f);
  NanoOptions options;
  for (const NanoValues values : {NanoValues::bits4, NanoValues::bits16}) {
    options.values = values;
    CHECK_THROWS_WITH(writeNanoVdb(path, {grid}, options),
                      Contains("v.nvdb: grid \"noise\": quantise: expected values"));
    CHECK(std::filesystem::is_empty(folder.path()));
  }
  options.values = NanoValues::float32;
  CHECK(writeNanoVdb(path, {grid}, options).front().max == 0);
}

TEST_CASE("A dense volume verifies within what building and quantising it cost together", "[grid]") {
  const TemporaryFolder folder;
  const glm::i64vec3 dims(30, 21, 18);
  TestRandom random(8);
  std::vector<float> voxels(static_cast<std::size_t>(dims.x * dims.y * dims.z));
  for (float& voxel : voxels) voxel = float(random.uniform() < 0.5 ? 0 : random.uniform(-1, 2));
  BuildOptions build;
  build.tolerance = 0.02f;
  build.clipBelow = -0.5f;
  for (const NanoValues values : {NanoValues::float32, NanoValues::bits4, NanoValues::bits16, NanoValues::adaptive}) {
    MemorySource source(dims, voxels);
    BuiltGrid built = buildGrid(source, build);
    NanoOptions options;
    options.values = values;
    options.maxError = 0.02f;
    VerifyReport seen;
    writeNanoVdb(folder.path() / "v.nvdb", {built.grid}, options, [&](const auto& written, const auto& errors) {
      addQuantising(built.report, errors.front(), /*activeOnly=*/false);
      MemorySource again(dims, voxels);
      seen = verifyGrid(again, *readBack(written, *built.grid), build, errors.front().max);
    });
    CHECK(seen.honours(built.report));
    CHECK(seen.wrongly == 0);
    if (values == NanoValues::adaptive) CHECK(seen.error.max <= 0.04);
    if (values == NanoValues::bits4) CHECK(seen.error.max > 0.5 * built.report.maxError);
  }
}

TEST_CASE("A file of any format that is not the grid is found out before it takes its name", "[grid]") {
  const TemporaryFolder folder;
  const ScalarGrid source{noiseAndTile(), "noise"};
  const BuiltGrid built = sparsifyGrid(source);
  const auto wrong = built.grid->deepCopy();
  wrong->tree().setValue(Coord(67, 3, 3), 0.625f);  // in the tile of 0.3
  const auto refuse = [&](const std::filesystem::path& written) {
    const auto back = readBack(written, *built.grid);
    const VerifyReport seen = verifyGrid(source, *back, {});
    CHECK(seen.voxels == source.grid->activeVoxelCount());
    CHECK(seen.beyond == 0);
    if (!seen.honours(built.report)) throw Error("found");
  };
  const auto write = [&](const std::filesystem::path& path, const openvdb::FloatGrid::ConstPtr& grid) {
    if (path.extension() == ".vdb")
      writeGrids(path, {grid}, {}, VdbCodec::blosc, refuse);
    else if (path.extension() == ".nvdb")
      writeNanoVdb(path, {grid}, {}, [&](const auto& written, const auto&) { refuse(written); });
    else
      writeDense(path, *grid, {}, refuse);
  };
  for (const char* name : {"v.vdb", "v.nvdb", "v.nrrd", "v.mhd"}) {
    CAPTURE(name);
    const auto path = folder.path() / name;
    CHECK_THROWS_WITH(write(path, wrong), "found");
    CHECK(std::filesystem::is_empty(folder.path()));
    write(path, built.grid);
    const std::string before = readBytes(path);
    CHECK_THROWS_WITH(write(path, wrong), "found");
    CHECK(readBytes(path) == before);
    const auto moved = built.grid->deepCopy();
    moved->setTransform(openvdb::math::Transform::createLinearTransform(1.5));
    CHECK_THROWS_WITH(write(path, moved), Contains("place of voxel ("));
    const auto other = built.grid->deepCopy();
    other->tree().root().setBackground(9, false);
    if (path.extension() == ".vdb") CHECK_THROWS_WITH(write(path, other), Contains("background: expected 0"));
    for (const auto& file : std::filesystem::directory_iterator(folder.path())) std::filesystem::remove(file);
  }
}
