// SPDX-License-Identifier: Apache-2.0
#include <openvdb/tools/LevelSetSphere.h>
#include <catch2/catch.hpp>

#include "convert/noisy_volume.h"
#include "umbrick/convert/convert.h"
#include "umbrick/convert/holds_grids.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/vdb/read_grid.h"

using namespace umbrick;
using Catch::Contains;

namespace {

openvdb::FloatGrid::Ptr ramp() {
  const auto grid = openvdb::FloatGrid::create(0);
  grid->setName("ramp");
  auto values = grid->getAccessor();
  for (int x = 0; x < 20; ++x) values.setValue({x, 1, 2}, float(x) + 1);
  return grid;
}

// A file with a scalar grid, vectors and a level set.
std::filesystem::path writeThree(const TemporaryFolder& folder) {
  const auto vectors = openvdb::Vec3SGrid::create();
  vectors->setName("velocity");
  vectors->tree().setValue({0, 0, 0}, {1, 2, 3});
  const auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(5, {0, 0, 0}, 1);
  sphere->setName("sphere");
  const auto path = folder.path() / "three.vdb";
  openvdb::io::File(path.string()).write(openvdb::GridCPtrVec{ramp(), vectors, sphere});
  return path;
}

}  // namespace

TEST_CASE("The report of a file of grids tells what was left out and what did not apply", "[convert]") {
  const TemporaryFolder folder;
  const auto input = writeThree(folder);
  ConvertOptions options;
  options.build.clipBelow = 11;
  options.verify = true;
  const auto output = folder.path() / "out.nvdb";
  const ConvertReport report = convert({input}, output, options);
  REQUIRE(report.leftOut.size() == 1);
  CHECK(report.leftOut[0].label == "velocity");
  CHECK(report.leftOut[0].type == "vec3s");
  REQUIRE(report.grids.size() == 2);
  CHECK(report.grids[0].label == "ramp");
  CHECK_FALSE(report.grids[0].keptLevelSet);
  CHECK(report.grids[0].build.activeVoxels == 10);
  CHECK_FALSE(report.grids[0].volumeType);
  CHECK(report.grids[1].keptLevelSet);
  CHECK(report.grids[1].verified->error.max == 0);
  const auto back = readScalarGrid(output, "ramp").grid;
  for (int x = 0; x < 20; ++x) CHECK(back->tree().getValue({x, 1, 2}) == (x >= 10 ? float(x) + 1 : 0));
}

TEST_CASE("One grid of a file is masked and cropped by its indices", "[convert]") {
  const TemporaryFolder folder;
  const auto input = writeThree(folder);
  ConvertOptions options;
  options.grids = {"ramp"};
  options.source.mask = folder.path() / "mask.vdb";
  options.source.crop = IndexBox{{0, 0, 0}, {9, 9, 9}};
  const auto mask = openvdb::FloatGrid::create(0);
  mask->fill(openvdb::CoordBBox({4, 0, 0}, {30, 3, 3}), 1.0f);
  openvdb::io::File(options.source.mask.string()).write(openvdb::GridCPtrVec{mask});
  const ConvertReport report = convert({input}, folder.path() / "out.vdb", options);
  REQUIRE(report.grids.size() == 1);
  CHECK(report.grids[0].masked == 4u);
  CHECK(report.grids[0].build.activeVoxels == 6);  // 4 to 9
  CHECK(report.leftOut.empty());

  options.source.crop = IndexBox{{30, 0, 0}, {31, 9, 9}};
  CHECK_THROWS_AS(convert({input}, folder.path() / "none.vdb", options), OptionsError);
}

TEST_CASE("What is for volumes is refused for a file of grids, by the name of the field", "[convert]") {
  const TemporaryFolder folder;
  const auto input = writeThree(folder);
  const auto refused = [&](const ConvertOptions& options, const char* message) {
    try {
      convert({input}, folder.path() / "out.vdb", options);
      FAIL("not refused");
    } catch (const OptionsError& error) {
      CHECK_THAT(error.what(), Contains(message));
    }
    CHECK_FALSE(std::filesystem::exists(folder.path() / "out.vdb"));
  };
  ConvertOptions options;
  options.source.resample = glm::dvec3(2);
  refused(options, "three.vdb: source.resample is for volumes");
  options = {};
  options.names = {"a"};
  refused(options, "options.names is for volumes");
  options = {};
  options.source.backgroundFromBorder = true;
  refused(options, "source.backgroundFromBorder is for volumes");
}

TEST_CASE("A file of grids is told by its name or its first bytes, and stands alone", "[convert]") {
  const TemporaryFolder folder;
  const auto input = writeThree(folder);
  const auto unnamed = folder.path() / "unnamed";
  std::filesystem::copy(input, unnamed);
  const auto raw = NoisyVolume(1).write(folder, "v.raw");
  CHECK(holdsGrids(input));
  CHECK(holdsGrids(unnamed));
  CHECK_FALSE(holdsGrids(raw));
  CHECK_FALSE(holdGrids({unnamed}, noisyOptions().source));  // raw, whatever it looks like
  CHECK_THROWS_AS(holdGrids({raw, unnamed}, {}), OptionsError);
}
