// What convert writes: verified before it takes its name, in few bits, from grids as from volumes, in bounded memory.
// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "tools/info_of.h"
#include "tools/program.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

// 40 x 24 x 16 voxels of a u8 ramp in a border of 0.
void writeRamp(const TemporaryFolder& folder, const std::string& name) {
  std::string voxels;
  for (int z = 0; z < 16; ++z)
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 40; ++x) {
        const bool inside = x > 2 && x < 37 && y > 2 && y < 21 && z > 2 && z < 13;
        voxels += static_cast<char>(inside ? 5 * x + y + z : 0);
      }
  writeBytes(folder.path() / name, "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 40 24 16\nencoding: raw\n\n" + voxels);
}

}  // namespace

TEST_CASE("Every output is verified, from volumes and from grids, each grid by itself", "[tools]") {
  const TemporaryFolder folder;
  writeRamp(folder, "a.nrrd");
  writeRamp(folder, "b.nrrd");
  for (const char* output : {"o.vdb", "o.nvdb", "o.mhd", "o.nrrd"}) {
    CAPTURE(output);
    const std::string to = std::string(" --verify -o ") + output;
    const ProgramResult volume = runProgram(folder, "convert a.nrrd --tolerance 30" + to);
    CHECK(volume.status == 0);
    CHECK_THAT(volume.out, Contains("15360 voxels read back, maximum error 30"));
    CHECK(runProgram(folder, "convert a.nrrd -o a.vdb").status == 0);
    const ProgramResult grid = runProgram(folder, "convert a.vdb --tolerance 30" + to);
    CHECK(grid.status == 0);
    CHECK_THAT(grid.out, Contains("6120 voxels read back, maximum error 30"));
    if (fs::path(output).extension() != ".vdb" && fs::path(output).extension() != ".nvdb") continue;
    const ProgramResult two = runProgram(folder, "convert a.nrrd b.nrrd --name '' --name density" + to);
    CHECK(two.status == 0);
    CHECK(two.out.find("read back") != two.out.rfind("read back"));
    CHECK(runProgram(folder, "convert " + kSmoke + "--half" + to).status == 0);
  }
}

TEST_CASE("Few bits a value cost what is printed, within what is asked for", "[tools]") {
  const TemporaryFolder folder;
  writeRamp(folder, "a.nrrd");
  const auto maxError = [&](const std::string& options) {
    const ProgramResult result = runProgram(folder, "convert a.nrrd --verify -o o.nvdb " + options);
    CAPTURE(options, result.err);
    REQUIRE(result.status == 0);
    std::smatch found;
    REQUIRE(std::regex_search(result.out, found, std::regex("maximum error   ([0-9.e+-]+)")));
    return std::stod(found[1]);
  };
  CHECK(maxError("") == 0);
  CHECK(maxError("--quantise 4") > maxError("--quantise 8"));
  CHECK(maxError("--quantise 8") > maxError("--quantise 16"));
  // The largest range of a leaf is below 255: half a step of it.
  CHECK(maxError("--quantise 8") <= 0.5 + 1e-4);
  for (const char* error : {"20", "3", "0.2"}) {
    const double found = maxError(std::string("--quantise n --max-error ") + error);
    CHECK(found <= std::stod(error));
    CHECK(found > 0);
  }
  CHECK(gridsOf(folder, "o.nvdb").at(0).at("active_voxels") == 6120);
  CHECK_THAT(runProgram(folder, "info o.nvdb").out, Contains("file version 32.4, written by NanoVDB 32.4"));
}

TEST_CASE("Grids are masked by grids and volumes, volumes by grids, and cropped by index", "[tools]") {
  const TemporaryFolder folder;
  writeRamp(folder, "a.nrrd");
  REQUIRE(runProgram(folder, "convert a.nrrd -o a.vdb").status == 0);
  REQUIRE(runProgram(folder, "convert a.nrrd --threshold 150 -o high.vdb").status == 0);
  const auto expected = gridsOf(folder, "high.vdb").at(0);
  for (const char* arguments : {"a.vdb --mask high.vdb", "a.nrrd --mask high.vdb",
                                "a.vdb --mask a.nrrd --threshold 150", "a.vdb --mask a.vdb --range 151 255"}) {
    CAPTURE(arguments);
    const ProgramResult result = runProgram(folder, std::string("convert --verify -o o.vdb ") + arguments);
    CHECK(result.status == 0);
    CHECK_THAT(result.out, Contains("masked"));
    CHECK(gridsOf(folder, "o.vdb").at(0).at("active_voxels") == expected.at("active_voxels"));
    CHECK(gridsOf(folder, "o.vdb").at(0).at("values") == expected.at("values"));
  }
  REQUIRE(runProgram(folder, "convert a.vdb --crop 10 4 5 19 8 7 --verify -o o.nvdb").status == 0);
  CHECK(gridsOf(folder, "o.nvdb").at(0).at("dims") == nlohmann::json::array({10, 5, 3}));
  CHECK(gridsOf(folder, "o.nvdb").at(0).at("index_box").at("min") == nlohmann::json::array({10, 4, 5}));
}

TEST_CASE("What makes no sense of grids and outputs is wrong usage and says why", "[tools]") {
  const TemporaryFolder folder;
  writeRamp(folder, "a.nrrd");
  REQUIRE(runProgram(folder, "convert a.nrrd -o a.nvdb").status == 0);
  const std::size_t before = filesIn(folder);
  const auto check = [&](const std::string& arguments, const std::string& message) {
    CAPTURE(arguments);
    const ProgramResult result = runProgram(folder, "convert " + arguments);
    CHECK(result.status == 2);
    CHECK_THAT(result.err, Contains(message));
    CHECK(result.out.empty());
    CHECK(filesIn(folder) == before);
  };
  check("a.nvdb --background auto -o o.vdb", "a.nvdb: --background auto is for volumes: a grid states its background");
  check("a.nvdb --name n -o o.vdb", "a.nvdb: --name is for volumes");
  check("a.nvdb --crop 100 0 0 109 9 9 -o o.vdb", "some of its active voxels, which lie from (3 3 3) to (36 20 12)");
  check("a.nvdb --mask a.nvdb --crop 5 5 5 4 4 4 -o o.vdb", "found (5 5 5) to (4 4 4)");
  check("a.nrrd --quantise 8 -o o.vdb", "o.vdb: --quantise is for .nvdb, not for .vdb");
  check("a.nrrd --quantise n -o o.nvdb", "expected a --max-error to keep, found none");
  check("a.nrrd --quantise 8 --max-error 1 -o o.nvdb", "which only --quantise n can keep");
  check("a.nrrd --quantise 5 -o o.nvdb", "--quantise");
  const ProgramResult few = runProgram(folder, "convert a.nrrd --quantise n --max-error 1e-6 -o o.nvdb");
  CHECK(few.status == 1);
  CHECK_THAT(few.err, Contains("o.nvdb: grid \"density\": 16 bits a value are too few"));
  CHECK(filesIn(folder) == before);
}
