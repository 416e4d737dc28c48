// Several volumes become grids of one file.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/info_of.h"
#include "tools/program.h"

using namespace umbrick;
using Catch::Contains;

namespace {

// 4 x 3 x 2 voxels of u8, `active` of them 9.
void writeNrrd(const TemporaryFolder& folder, const std::string& name, std::size_t active) {
  std::string voxels(24, '\0');
  for (std::size_t i = 0; i < active; ++i) voxels[2 * i] = 9;
  writeBytes(folder.path() / name, "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 3 2\nspacings: 1 1 " +
                                       std::to_string(active) + "\nencoding: raw\n\n" + voxels);
}

}  // namespace

TEST_CASE("Several volumes become grids of one file, each with its name, place and unit", "[tools]") {
  const TemporaryFolder folder;
  writeNrrd(folder, "a.nrrd", 3);
  writeNrrd(folder, "b.nrrd", 5);
  const ProgramResult stems = runProgram(folder, "convert a.nrrd b.nrrd --verify -o x.vdb");
  CHECK(stems.status == 0);
  CHECK_THAT(stems.out, Contains("grid \"a\"") && Contains("grid \"b\""));
  nlohmann::json grids = gridsOf(folder, "x.vdb");
  REQUIRE(grids.size() == 2);
  CHECK(grids.at(0).at("name") == "a");
  CHECK(grids.at(0).at("active_voxels") == 3);
  CHECK(grids.at(1).at("name") == "b");
  CHECK(grids.at(1).at("active_voxels") == 5);
  CHECK(grids.at(1).at("voxel_size").at(2) == 5);

  CHECK(runProgram(folder, "convert --name heat --unit K a.nrrd b.nrrd --name smoke --unit kg/m3 -o y.vdb").status ==
        0);
  grids = gridsOf(folder, "y.vdb");
  CHECK(grids.at(0).at("name") == "heat");
  CHECK(grids.at(0).at("metadata").at("value_unit") == "K");
  CHECK(grids.at(1).at("name") == "smoke");
  CHECK(grids.at(1).at("metadata").at("value_unit") == "kg/m3");
}

TEST_CASE("Inputs that cannot stand beside each other are refused in one line, and nothing is written", "[tools]") {
  const TemporaryFolder folder;
  writeNrrd(folder, "a.nrrd", 3);
  writeNrrd(folder, "a.b.nrrd", 3);
  std::filesystem::create_directory(folder.path() / "sub");
  std::filesystem::copy(folder.path() / "a.nrrd", folder.path() / "sub/a.nrrd");
  writeBytes(folder.path() / "short.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 3 2\nencoding: raw\n\nabc");
  const std::size_t before = filesIn(folder);
  const auto check = [&](const std::string& arguments, int status, const std::string& message) {
    CAPTURE(arguments);
    const ProgramResult result = runProgram(folder, "convert " + arguments + " -o x.vdb");
    CHECK(result.status == status);
    CHECK_THAT(result.err, Contains(message));
    CHECK(filesIn(folder) == before);
  };
  check("a.nrrd sub/a.nrrd", 2, "found \"a\" for both a.nrrd and sub/a.nrrd");
  check("a.nrrd a.b.nrrd --name n", 2, "expected one for each of 2 inputs, found 1");
  check("a.nrrd a.b.nrrd --name n --name n", 2, "found \"n\" for both a.nrrd and a.b.nrrd");
  check("a.nrrd --unit K --unit C", 2, "for each of 1 inputs, found 2");
  check("a.nrrd '" UMBRICK_ASSETS "/densityAndHeat.vdb'", 2, "found a file of grids");
  check("a.nrrd short.nrrd", 1, "short.nrrd: ");
  check("a.nrrd missing.nrrd", 1, "missing.nrrd: cannot read: No such file");
}

TEST_CASE("Worlds that differ are brought to one, which is said in a line", "[tools]") {
  const TemporaryFolder folder;
  const auto write = [&](const char* name, const char* space) {
    writeBytes(folder.path() / name, std::string("NRRD0004\ntype: uint8\ndimension: 3\nspace: ") + space +
                                         "\nsizes: 2 2 2\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
                                         "space origin: (10,20,30)\nencoding: raw\n\n" +
                                         std::string(8, '\5'));
  };
  write("l.nrrd", "LPS");
  write("r.nrrd", "RAS");
  const ProgramResult both = runProgram(folder, "convert l.nrrd r.nrrd -o x.vdb");
  CHECK(both.status == 0);
  CHECK_THAT(both.err, Contains("r.nrrd: its world is turned from RAS to LPS, that of l.nrrd"));
  const nlohmann::json grids = gridsOf(folder, "x.vdb");
  CHECK(grids.at(1).at("world_bounds").at("max").at(0) == -10);
  CHECK(grids.at(1).at("metadata").at("space") == "LPS");
  const ProgramResult turned = runProgram(folder, "convert l.nrrd --space ras -o y.mhd");
  CHECK(turned.status == 0);
  CHECK_THAT(turned.err, Contains("LPS to RAS") && Contains("y.mhd: the place is written in LPS"));
}

TEST_CASE("An empty or a full result is said in a line that names the option", "[tools]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "v.nrrd",
             "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nspacings: 1 1 1\n"
             "encoding: raw\n\n" +
                 std::string(64, '\7'));
  CHECK_THAT(runProgram(folder, "convert v.nrrd -o x.vdb").err,
             Contains("100.0 % of its voxels are 7 and active") && Contains("--background auto or 7"));
  CHECK_THAT(runProgram(folder, "convert v.nrrd --background 7 -o x.vdb").err, Contains("nothing is left"));
  CHECK_THAT(runProgram(folder, "convert v.nrrd --threshold -5 --background 0 -o x.vdb").err,
             Contains("--background: what is left out lies below -5"));
}
