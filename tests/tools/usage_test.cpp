// What the program says to who gives too little, and where an option helps.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/program.h"

using namespace umbrick;
using Catch::Contains;

namespace {

// The two grids of the bundled smoke in one file.
void writeGridsOf(const TemporaryFolder& folder) {
  REQUIRE(runProgram(folder, "convert " + kSmoke + "-o both.vdb").status == 0);
}

}  // namespace

TEST_CASE("The bare name of the program is answered by three useful lines and the status of wrong usage", "[tools]") {
  const TemporaryFolder folder;
  const ProgramResult result = runProgram(folder, "");
  CHECK(result.status == 2);
  CHECK(result.out.empty());
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 3);
  CHECK_THAT(result.err, Contains("umbrick render INPUT -o picture.png") && Contains("umbrick --help"));
  const ProgramResult help = runProgram(folder, "--help");
  CHECK(help.status == 0);
  for (const char* command : {"convert", "info", "render", "reference", "compare", "check", "study"})
    CHECK_THAT(help.out, Contains(command));
}

TEST_CASE("A format of one grid says which option names it", "[tools]") {
  const TemporaryFolder folder;
  writeGridsOf(folder);
  const ProgramResult refused = runProgram(folder, "convert both.vdb -o a.nrrd");
  CHECK(refused.status == 2);
  CHECK(refused.err ==
        "umbrick: a.nrrd: expected one grid for .nrrd, found 2; name one with --grid: \"density\", \"heat\"\n");
  CHECK(runProgram(folder, "convert both.vdb --grid heat -o a.nrrd").status == 0);
}

TEST_CASE("Several grids of a file are converted and described by their names", "[tools]") {
  const TemporaryFolder folder;
  writeGridsOf(folder);
  const auto namesIn = [&](const std::string& arguments) {
    std::vector<std::string> names;
    const auto file = nlohmann::json::parse(runProgram(folder, "info --json " + arguments).out);
    for (const auto& grid : file.at("grids")) names.push_back(grid.at("name"));
    return names;
  };
  using Names = std::vector<std::string>;
  REQUIRE(runProgram(folder, "convert both.vdb --grid heat --grid density -o two.vdb").status == 0);
  CHECK(namesIn("two.vdb") == Names{"heat", "density"});
  REQUIRE(runProgram(folder, "convert --grid heat both.vdb -o one.vdb").status == 0);
  CHECK(namesIn("one.vdb") == Names{"heat"});
  CHECK(namesIn("two.vdb --grid density") == Names{"density"});
  CHECK(namesIn("two.vdb --grid density --grid heat") == Names{"heat", "density"});  // in the order of the file

  const auto refused = [&](const std::string& arguments, int status, const std::string& message) {
    CAPTURE(arguments);
    const ProgramResult result = runProgram(folder, arguments);
    CHECK(result.status == status);
    CHECK_THAT(result.err, Contains(message));
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  };
  refused("convert both.vdb --grid heat --grid heat -o a.vdb", 2,
          "--grid: expected each grid once, found \"heat\" twice");
  refused("info both.vdb --grid smoke", 1, "both.vdb: no grid \"smoke\": the file has \"density\", \"heat\"");
  refused("convert " + kHead + "--grid ct -o a.vdb", 2, "--grid is for files of grids: a volume has one");
  // A picture is made of one grid.
  refused("render both.vdb --grid heat --grid density --tf smoke -o a.png", 2, "--grid");
}

TEST_CASE("What a scene cannot have is said with the option that changes it", "[tools]") {
  const TemporaryFolder folder;
  writeGridsOf(folder);
  const auto check = [&](const std::string& arguments, const std::string& message) {
    CAPTURE(arguments);
    const ProgramResult result = runProgram(folder, arguments);
    CHECK(result.status != 0);
    CHECK_THAT(result.err, Contains(message));
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  };
  check("render both.vdb --tf smoke --spacing 10000 -o a.png", "sampling.spacing (--spacing): slices ");
  check("render both.vdb --tf smoke --model cone-ray -o a.png",
        "model (--model): cone-ray is integrated by the reference");
}
