// SPDX-License-Identifier: Apache-2.0
#include <openvdb/io/Stream.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/vdb/grid_listing.h"
#include "umbrick/vdb/read_grid.h"
#include "umbrick/vdb/summary.h"
#include "umbrick/vdb/write_volume.h"

using namespace umbrick;
namespace fs = std::filesystem;
using Catch::Contains;
using openvdb::Coord;

// OpenVDB leaks the node at hand when the packed values of one of its nodes are broken.
extern "C" const char* __lsan_default_suppressions() { return "leak:readTopology\n"; }

namespace {

// OpenVDB makes the grid itself, by the name of its type, so that this file need not compile each type.
template <class Grid>
typename Grid::Ptr gridOf(const std::string& name, const typename Grid::ValueType& value) {
  openvdb::initialize();
  const auto grid = openvdb::gridPtrCast<Grid>(openvdb::GridBase::createGrid(Grid::gridType()));
  grid->setName(name);
  grid->tree().setValue(Coord(1, 2, 3), value);
  return grid;
}

void writeAny(const fs::path& path, const openvdb::GridPtrVec& grids) { openvdb::io::File(path.string()).write(grids); }

// Reads all there is in a file. @return false when an IoError told that the file is broken
bool readsOrTells(const fs::path& path) {
  try {
    for (const GridListing::Row& row : listGrids(path).grids)
      if (row.scalar) readScalarGridAnyTransform(path, row.label);
    summariseFile(path, 4);
    return true;
  } catch (const IoError&) {
    return false;
  }
}

}  // namespace

TEST_CASE("Grids are selected by name, by index, or as the only scalar one", "[grid]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "g.vdb";
  writeAny(path, {gridOf<openvdb::FloatGrid>("heat", 1), gridOf<openvdb::FloatGrid>("density", 2),
                  gridOf<openvdb::FloatGrid>("heat", 3), gridOf<openvdb::FloatGrid>("", 4)});
  const auto valueOf = [&](const std::string& selector) {
    return readScalarGrid(path, selector).grid->tree().getValue(Coord(1, 2, 3));
  };
  CHECK(valueOf("") == 2);
  CHECK(valueOf("heat") == 1);
  CHECK(valueOf("heat[0]") == 1);
  CHECK(valueOf("heat[1]") == 3);
  CHECK(valueOf("[0]") == 4);
  CHECK_THROWS_AS(valueOf("heat[2]"), InvalidArgument);
  CHECK_THROWS_WITH(valueOf("smoke"), Contains("no grid \"smoke\"") && Contains("\"heat[0]\" (float)") &&
                                          Contains("\"heat[1]\"") && Contains("\"density\""));
  writeAny(path, {gridOf<openvdb::FloatGrid>("a", 1), gridOf<openvdb::FloatGrid>("b", 2)});
  CHECK_THROWS_WITH(valueOf(""), Contains("name a grid"));
  CHECK_THROWS_AS(valueOf(""), SeveralGrids);
  writeAny(path, {gridOf<openvdb::FloatGrid>("a", 7), gridOf<openvdb::MaskGrid>("b", true)});
  CHECK(valueOf("") == 7);
}

TEST_CASE("Only scalar grids are read as scalars, and the message names the type", "[grid]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "g.vdb";
  writeAny(path, {gridOf<openvdb::Vec3SGrid>("v", openvdb::Vec3s(1)), gridOf<openvdb::MaskGrid>("m", true),
                  gridOf<openvdb::BoolGrid>("b", true)});
  CHECK_THROWS_WITH(readScalarGrid(path, "v"), Contains("grid \"v\": expected a scalar grid, found vec3s"));
  CHECK_THROWS_WITH(readScalarGrid(path, "m"), Contains("found mask"));
  CHECK_THROWS_WITH(readScalarGrid(path, "b"), Contains("found bool"));
  CHECK_THROWS_WITH(readScalarGrid(path), Contains("no scalar grid"));
}

TEST_CASE("Doubles and integers become floats with the error stated", "[grid]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "g.vdb";
  const auto wide = gridOf<openvdb::DoubleGrid>("double", 0.1);
  wide->tree().addTile(1, Coord(80, 0, 0), 1.0 / 3, true);
  wide->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
  wide->insertMeta("note", openvdb::StringMetadata("kept"));
  writeAny(path, {wide, gridOf<openvdb::Int32Grid>("int32", 16777217),
                  gridOf<openvdb::Int64Grid>("int64", (1LL << 60) + 1), gridOf<openvdb::FloatGrid>("float", 0.1f)});
  const ScalarGrid fromDouble = readScalarGrid(path, "double");
  CHECK(fromDouble.conversionError == std::max(std::abs(0.1 - double(0.1f)), std::abs(1.0 / 3 - double(1.0f / 3))));
  CHECK(fromDouble.grid->tree().getValue(Coord(84, 4, 4)) == 1.0f / 3);
  CHECK(fromDouble.grid->transform().voxelSize() == openvdb::Vec3d(0.25));
  CHECK(fromDouble.grid->metaValue<std::string>("note") == "kept");
  CHECK(readScalarGrid(path, "int32").conversionError == 1);
  CHECK(readScalarGrid(path, "int64").conversionError == 1);
  CHECK(readScalarGrid(path, "float").conversionError == 0);
}

TEST_CASE("Boxes reach to the ends of 32-bit indices", "[grid]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "g.vdb";
  const auto grid = openvdb::FloatGrid::create();
  const int far = 2147483647;
  grid->tree().setValue(Coord(-far - 1, -5, 0), 1);
  grid->tree().setValue(Coord(far, 6, far), 2);
  grid->setName("far");
  writeGrids(path, {grid});
  const ScalarGrid read = readScalarGrid(path);
  CHECK(read.activeBox() == IndexBox{{-far - 1, -5, 0}, {far, 6, far}});
  CHECK(read.activeBox().extent() == glm::i64vec3(std::int64_t(1) << 32, 12, std::int64_t(1) << 31));
  CHECK(read.worldBounds().max.x == double(far));
  CHECK(summariseFile(path).grids.at(0).activeBox == read.activeBox());
}

TEST_CASE("A grid with a frustum transform is not for rendering, but can be summarised and copied", "[grid]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "g.vdb";
  const auto grid = gridOf<openvdb::FloatGrid>("f", 3);
  grid->setTransform(
      openvdb::math::Transform::createFrustumTransform(openvdb::BBoxd({0, 0, 0}, {10, 10, 10}), 0.5, 2.0));
  writeAny(path, {grid});
  CHECK_THROWS_WITH(readScalarGrid(path), Contains("expected an affine transform"));
  CHECK(readScalarGridAnyTransform(path, "f").grid->transform() == grid->transform());
  const GridSummary summary = summariseFile(path).grids.at(0);
  CHECK(summary.transformType == "frustum");
  CHECK_FALSE(summary.indexToWorld);
  CHECK_FALSE(summary.worldBounds.empty());
}

TEST_CASE("A summary agrees with a plain count", "[grid]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "g.vdb";
  const auto grid = openvdb::FloatGrid::create(-1);
  grid->setName("g");
  for (int i = 0; i < 100; ++i) grid->tree().setValue(Coord(i, -i, 2 * i), float(i));
  grid->tree().setValue(Coord(0, 0, 500), std::nanf(""));
  grid->tree().addTile(1, Coord(800, 0, 0), 99, true);
  const auto vectors = gridOf<openvdb::Vec3SGrid>("v", openvdb::Vec3s(2, 3, 6));
  writeAny(path, {grid, vectors, gridOf<openvdb::MaskGrid>("m", true), openvdb::FloatGrid::create()});
  const FileSummary file = summariseFile(path, 10);
  REQUIRE(file.grids.size() == 4);
  const GridSummary& summary = file.grids[1];  // grids are sorted by name, as they were written
  const auto find = [&](const std::string& label) {
    for (const GridSummary& each : file.grids)
      if (each.label == label) return each;
    FAIL("no grid " << label);
    return summary;
  };
  const GridSummary g = find("g");
  CHECK(g.activeVoxels == 101 + 512);
  CHECK(g.activeTiles == 1);
  REQUIRE(g.values);
  CHECK(g.values->min == 0);
  CHECK(g.values->max == 99);
  CHECK(g.values->nonFinite == 1);
  CHECK(g.values->histogram == std::vector<std::uint64_t>{10, 10, 10, 10, 10, 10, 10, 10, 10, 522});
  CHECK(g.background == "-1");
  CHECK(g.activeBox == IndexBox{{0, -99, 0}, {807, 7, 500}});
  CHECK(g.fileBytes > 0);
  CHECK(g.memoryBytes > 0);
  CHECK(find("v").values->magnitude);
  CHECK(find("v").values->max == 7);
  CHECK_FALSE(find("v").scalar);
  CHECK(find("m").activeVoxels == 1);
  CHECK_FALSE(find("m").values);
  CHECK(find("[0]").activeBox.empty());
  CHECK(file.fileBytes == static_cast<std::int64_t>(fs::file_size(path)));
}

TEST_CASE("The bundled smoke has the voxels it is known for", "[grid]") {
  const FileSummary file = summariseFile(UMBRICK_ASSETS "/densityAndHeat.vdb");
  REQUIRE(file.grids.size() == 2);
  CHECK(file.grids[0].activeVoxels == 6124);
  CHECK(file.grids[0].activeBox == IndexBox{{1, 1, 31}, {23, 23, 72}});
  CHECK(file.grids[1].activeVoxels == 5224);
  CHECK(file.grids[1].activeBox == IndexBox{{2, 2, 31}, {23, 22, 62}});
  CHECK(readScalarGrid(UMBRICK_ASSETS "/densityAndHeat.vdb").name == "density");
}

TEST_CASE("A file that is not a .vdb of a known version is refused, and the message says why", "[grid]") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(readScalarGrid(folder.path()), Contains("found a directory"));
  CHECK_THROWS_WITH(readScalarGrid(folder.path() / "none.vdb"), Contains("no such file"));
  writeBytes(folder.path() / "e.vdb", "");
  CHECK_THROWS_WITH(readScalarGrid(folder.path() / "e.vdb"), Contains("expected a .vdb file"));
  writeBytes(folder.path() / "p.vdb", "NRRD0004 and more of it");
  CHECK_THROWS_AS(readScalarGrid(folder.path() / "p.vdb"), IoError);
  std::string bytes = readBytes(UMBRICK_ASSETS "/densityAndHeat.vdb");
  bytes[8] = 99;
  writeBytes(folder.path() / "v.vdb", bytes);
  CHECK_THROWS_WITH(readScalarGrid(folder.path() / "v.vdb"), Contains("file version: expected 222 to 224, found 99"));
}

TEST_CASE("A truncated .vdb is an IoError at every length", "[grid]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "t.vdb";
  const std::string bytes = readBytes(UMBRICK_ASSETS "/densityAndHeat.vdb");
  for (std::size_t length = 0; length < bytes.size(); length += length < 400 ? 1 : 397) {
    CAPTURE(length);
    writeBytes(path, bytes.substr(0, length));
    REQUIRE_FALSE(readsOrTells(path));
  }
  writeBytes(path, bytes);
  CHECK(readsOrTells(path));
}

TEST_CASE("A stream without a table of grids is read, and truncation told", "[grid]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "s.vdb";
  openvdb::initialize();
  std::ostringstream out;
  openvdb::io::Stream(out).write(
      openvdb::GridCPtrVec{gridOf<openvdb::FloatGrid>("a", 5), gridOf<openvdb::FloatGrid>("b", 6)});
  const std::string bytes = out.str();
  writeBytes(path, bytes);
  CHECK(readScalarGrid(path, "b").grid->tree().getValue(Coord(1, 2, 3)) == 6);
  for (std::size_t length = 0; length < bytes.size(); length += 61) {
    writeBytes(path, bytes.substr(0, length));
    REQUIRE_FALSE(readsOrTells(path));
  }
}

// Some changes give another grid, and the others must be told. None may crash, hang or exhaust the memory.
TEST_CASE("A .vdb with flipped bytes ends in a grid or an IoError", "[grid]") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "c.vdb";
  const std::string good = readBytes(UMBRICK_ASSETS "/densityAndHeat.vdb");
  std::mt19937 random(2);
  int told = 0;
  for (int trial = 0; trial < 500; ++trial) {
    std::string bytes = good;
    // Every other trial changes the first 2000 bytes: header, metadata, transform and the top of the tree.
    const std::size_t reach = trial % 2 ? 2000 : bytes.size();
    for (int i = 0; i < 1 + trial % 4; ++i) bytes[random() % reach] = static_cast<char>(random());
    writeBytes(path, bytes);
    told += !readsOrTells(path);
  }
  CHECK(told > 50);  // of 500
}

TEST_CASE("Writing that fails leaves no file", "[grid]") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(writeGrids(folder.path() / "none" / "g.vdb", {gridOf<openvdb::FloatGrid>("a", 1)}), IoError);
  CHECK_THROWS_AS(writeGrids(folder.path(), {gridOf<openvdb::FloatGrid>("a", 1)}), IoError);
  CHECK(fs::is_empty(folder.path()));
}
