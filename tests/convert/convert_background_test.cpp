// Backgrounds that would turn air into tissue, and active voxels that have the background.
// SPDX-License-Identifier: Apache-2.0
#include <openvdb/io/File.h>

#include <catch2/catch.hpp>

#include "convert/noisy_volume.h"
#include "umbrick/convert/convert.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/vdb/read_grid.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

// As a CT in Hounsfield units: air of -1000 around tissue from 0 to 100.
struct Scan {
  TemporaryFolder folder;
  NoisyVolume volume{11, -1000};
  fs::path input = volume.write(folder, "ct.raw"), out = folder.path() / "out.vdb";
};

ConvertOptions above(float limit) {
  ConvertOptions options = noisyOptions();
  options.build.clipBelow = limit;
  return options;
}

}  // namespace

TEST_CASE("Where limits would keep the usual background, that of the border is taken and said", "[convert]") {
  const Scan scan;
  const ConvertReport report = convert({scan.input}, scan.out, above(-500));
  CHECK(readScalarGrid(scan.out).grid->background() == -1000);
  CHECK(report.grids[0].build.activeVoxels == 16 * 16 * 16);
  CHECK(report.grids[0].background->value == -1000);
  CHECK_THAT(report.grids[0].notes.at(0), Contains("border"));
  // Above the limit lies nothing that is left out, so that 0 is fit.
  CHECK(convert({scan.input}, scan.out, above(10)).grids[0].notes.empty());
  CHECK(readScalarGrid(scan.out).grid->background() == 0);
  ConvertOptions range = above(0);
  range.build.clipAbove = 50.0f;  // 0 is the least that stays
  CHECK(convert({scan.input}, scan.out, range).grids[0].notes.empty());
  range.build.clipBelow = -2000.0f;
  range.build.clipAbove = -500.0f;  // 0 is not among those that stay
  CHECK(convert({scan.input}, scan.out, range).grids[0].notes.empty());
}

TEST_CASE("A background that limits would keep is refused", "[convert]") {
  const Scan scan;
  ConvertOptions options = above(-500);
  options.build.background = 0.0f;
  CHECK_THROWS_WITH(convert({scan.input}, scan.out, options),
                    Contains("build.background") && Contains("-500") && Contains("become 0"));
  options.build.background = {};
  options.build.clipBelow = -1500.0f;  // the border itself stays
  CHECK_THROWS_WITH(convert({scan.input}, scan.out, options), Contains("-1000") && Contains("border"));
  CHECK(!fs::exists(scan.out));

  convert({scan.input}, scan.out, noisyOptions());
  ConvertOptions grid;
  grid.build.clipBelow = -500.0f;
  const auto again = scan.folder.path() / "again.vdb";
  CHECK_THROWS_WITH(convert({scan.out}, again, grid), Contains("build.background") && Contains("that of the grid"));
  grid.build.background = -1000.0f;
  CHECK(convert({scan.out}, again, grid).grids[0].build.activeVoxels == 16 * 16 * 16);
}

TEST_CASE("Active voxels of a grid that have its background stay active", "[convert]") {
  openvdb::initialize();
  const TemporaryFolder folder;
  auto grid = openvdb::FloatGrid::create(7);
  grid->setName("density");
  grid->denseFill(openvdb::CoordBBox({1, 1, 1}, {10, 10, 10}), 7, true);
  grid->tree().setValue({3, 3, 3}, 8);
  const auto input = folder.path() / "in.vdb", out = folder.path() / "out.vdb";
  openvdb::io::File(input.string()).write({grid});
  ConvertOptions options;
  options.verify = true;
  const ConvertReport report = convert({input}, out, options);
  CHECK(report.grids[0].build.activeVoxels == 1000);
  CHECK(readScalarGrid(out).grid->activeVoxelCount() == 1000);
  CHECK(readScalarGrid(out).grid->tree().hasSameTopology(grid->tree()));
  options.build.tolerance = 0.5f;  // asks for it
  CHECK(convert({input}, out, options).grids[0].build.activeVoxels == 1);
}

TEST_CASE("A result that is mostly one value, or nearly all active, is reported", "[convert]") {
  const Scan scan;
  const ConvertedGrid plain = convert({scan.input}, scan.out, noisyOptions()).grids[0];
  REQUIRE(plain.usual);
  CHECK(plain.usual->value == -1000);
  CHECK(plain.usual->voxels == 24 * 24 * 24 - 16 * 16 * 16);
  CHECK(plain.border == -1000.0f);
  ConvertOptions border = noisyOptions();
  border.source.backgroundFromBorder = true;
  const ConvertedGrid sparse = convert({scan.input}, scan.out, border).grids[0];
  CHECK(!sparse.usual);
  CHECK(!sparse.border);
}

TEST_CASE("A surface below the usual background gets that of the border", "[convert]") {
  const Scan scan;
  ConvertOptions options = noisyOptions();
  options.isosurface = IsosurfaceOptions{-300};
  const ConvertReport report = convert({scan.input}, scan.out, options);
  CHECK(report.grids[0].background->value == -1000);
  CHECK_THAT(report.grids[0].notes.at(0), Contains("border"));
  CHECK(report.grids[0].isosurface->crossings == 6 * 16 * 16);
  CHECK(readScalarGrid(scan.out).isLevelSet());
}
