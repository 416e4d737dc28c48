// A volume on a lattice of other spacing, as a user makes it.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/program.h"
#include "tools/refusal.h"

using namespace umbrick;
using Catch::Contains;

TEST_CASE("A resampled volume says what it changed, keeps that, and verifies", "[tools]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "v.raw", std::string("\0\2\4\6\1\1\3\3", 8));
  const std::string start = "convert v.raw --dims 4 2 1 --type u8 --spacing 0.5 0.5 2 --verify -o v.vdb ";
  const ProgramResult halved = runProgram(folder, start + "--resample 1 1 2");
  CHECK(halved.status == 0);
  // (0 2 1 1) and (4 6 3 3) become 1 and 4; the differences are 1 1 0 0 and 0 2 1 1.
  CHECK_THAT(halved.out, Contains("resampled       4 x 2 x 1 voxels to 2 x 1 x 1, 1 x 1 x 2 apart\n") &&
                             Contains("changes       2 at most, RMS 1; integral 10 before, 10 after\n") &&
                             Contains("active voxels   2 of 2") && Contains("maximum error   0\n"));
  const nlohmann::json grid = nlohmann::json::parse(runProgram(folder, "info v.vdb --json").out).at("grids").at(0);
  CHECK(grid.at("voxel_size") == nlohmann::json::array({1, 1, 2}));
  CHECK(grid.at("index_to_world").at(0).at(3) == 0.25);
  CHECK(grid.at("values").at("max") == 4);
  CHECK(grid.at("metadata").at("resample_error_max") == "2");
  CHECK(grid.at("metadata").at("resample_error_rms") == "1");
  CHECK(grid.at("metadata").at("resample_integral_after") == "10");
  CHECK(grid.at("metadata").at("resample_spacing") == "[1, 1, 2]");
}

TEST_CASE("A spacing that cannot be resampled to is refused in one line", "[tools]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "v.raw", "abcdefgh");
  const auto refused = [&](const std::string& arguments, int status, const std::string& message) {
    expectRefusal(folder, "convert " + arguments + " -o o.vdb", status, message);
  };
  const std::string raw = "v.raw --dims 2 2 2 --type u8 ";
  refused(raw + "--resample 1 2", 2, "--resample: expected one spacing or three, found 2");
  refused(raw + "--resample 0", 2, "--resample");
  refused(raw + "--resample 1e-30", 1, "v.raw: resample: expected a spacing of at most 2147483647 voxels");
  refused("'" UMBRICK_ASSETS "/densityAndHeat.vdb' --resample 1", 2,
          "--resample is for volumes: a grid keeps its voxels");
}
