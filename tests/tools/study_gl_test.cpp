// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "support/gl_fixture.h"
#include "support/xml.h"
#include "tools/program.h"

using namespace umbrick;
namespace fs = std::filesystem;
using Catch::Contains;
using Json = nlohmann::ordered_json;

namespace {

const std::string kStudySmoke = "study " + kSmoke + "--grid density --tf smoke --azimuth 0 ";
// Every axis has two values, all of them small.
const std::string kTiny =
    kStudySmoke +
    "--quick --slices 16 32 --footprints 1 2 --directions 2 4 --scales 0.5 --sizes 16 32 --thetas 30 60 --repeats 1 "
    "--reference-directions 8 --reference-tolerance 0.05 -o report";

// Returns the commands of a case in the page, as a shell takes them.
std::string commandsOf(const std::string& page, const std::string& id) {
  const std::size_t begin = page.find("<pre>", page.find("id=\"c-" + id + "\"")) + 5;
  return page.substr(begin, page.find("</pre>", begin) - begin);
}

}  // namespace

TEST_CASE("A study of a bundled volume is written whole, and its commands make its numbers again", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  const ProgramResult result = runProgram(folder, kTiny);
  CHECK(result.err.empty());
  REQUIRE(result.status == 0);
  CHECK(result.out == "report/index.html\nreport/study.csv\nreport/study.json\n");
  const fs::path report = folder.path() / "report";
  const std::string page = readBytes(report / "index.html");
  CHECK(xmlFault(page) == "");
  const std::string table = readBytes(report / "study.csv");
  const Json record = Json::parse(readBytes(report / "study.json"));
  const Json& cases = record["cases"];
  CHECK(static_cast<std::size_t>(std::count(table.begin(), table.end(), '\n')) == 1 + cases.size());
  for (const Json& one : cases) {
    const std::string id = one["id"];
    CHECK(fs::exists(report / "pictures" / (id + ".png")));
    CHECK(fs::exists(report / "pictures" / (id + ".error.png")));
    CHECK_THAT(table, Contains("\n" + id + ","));
  }
  for (const char* plot : {"pareto-cone", "pareto-emission", "convergence-cone", "convergence-emission"})
    for (const char* ending : {".svg", ".gp", ".dat"})
      CHECK(fs::exists(report / "plots" / (std::string(plot) + ending)));

  // One case of each method is rendered and compared as the page says.
  for (const char* method : {"emission", "dos", "ordinates"}) {
    const Json& one = *std::find_if(cases.begin(), cases.end(), [&](const Json& c) { return c["method"] == method; });
    const std::string commands = commandsOf(page, one["id"]);
    const std::size_t line = commands.find('\n');
    const std::string prefix = "umbrick ";
    REQUIRE(commands.starts_with(prefix));
    REQUIRE(commands.compare(line + 1, prefix.size(), prefix) == 0);
    const std::string there = "/dev/null; (cd report && '" UMBRICK_PROGRAM "' ";
    CAPTURE(commands);
    const std::string render = commands.substr(prefix.size(), line - prefix.size());
    REQUIRE(runProgram(folder, "--version >" + there + render + ")").status == 0);
    const ProgramResult compared =
        runProgram(folder, "--version >" + there + commands.substr(line + 1 + prefix.size()) + " --json)");
    REQUIRE(compared.status == 0);
    // The same program must give the same numbers.
    const Json layer = Json::parse(compared.out)["layers"][0];
    CHECK(layer["rmse_rgb"] == one["error"]["rmse"]);
    CHECK(layer["flip"] == one["error"]["flip"]);
  }
}

TEST_CASE("A complete study is only shown again", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  const std::string small = kStudySmoke +
                            "--methods emission dos --slices 8 16 --footprints 2 --bits 32 --segments 1 --sizes 16 "
                            "--thetas 60 --repeats 1 --reference-directions 8 --reference-tolerance 0.05 -o report";
  REQUIRE(runProgram(folder, small).status == 0);
  const auto contents = [&] {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder.path() / "report"))
      all[entry.path().string()] = entry.is_regular_file() ? readBytes(entry.path()) : "folder";
    return all;
  };
  const auto before = contents();
  fs::remove(folder.path() / "report" / "index.html");
  fs::remove_all(folder.path() / "report" / "plots");
  REQUIRE(runProgram(folder, small).status == 0);
  CHECK(contents() == before);
}

TEST_CASE("Without gnuplot a study does not begin", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  const ProgramResult result = runProgram(folder, kStudySmoke + "--quick -o report");
  setenv("PATH", path.c_str(), 1);
  CHECK(result.status == 1);
  CHECK_THAT(result.err, Contains("gnuplot: cannot be run") && Contains("gnuplot-nox"));
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  CHECK(!fs::exists(folder.path() / "report"));
}

TEST_CASE("Studies that cannot be made say so in one line and leave nothing behind", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  const auto check = [&](const std::string& arguments, int status, const std::string& message) {
    CAPTURE(arguments);
    const std::size_t before = filesIn(folder);
    const ProgramResult result = runProgram(folder, arguments);
    CHECK(result.status == status);
    CHECK_THAT(result.err, Contains(message));
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK(result.out.empty());
    CHECK(filesIn(folder) == before);
  };
  check(kStudySmoke, 2, "--output");
  check(kStudySmoke + "-o r --methods dos guessing", 1, "methods: no method 'guessing': there are emission, ");
  check(kStudySmoke + "-o r --slices 0", 1, "slices: is 0");
  check(kStudySmoke + "-o r --slices many", 2, "--slices");
  check(kStudySmoke + "-o r --bits 32:16", 2, "--bits: expected BITS or EYE/OCCLUSION, found '32:16'");
  check(kStudySmoke + "-o r --bits 8", 1, "bits: is 8, must be 16 or 32");
  check(kStudySmoke + "-o r --thetas 90", 1, "thetas: is 90 degrees");
  check(kStudySmoke + "-o r --reference-directions 1", 2, "--reference-directions");
  check(kStudySmoke + "-o r --methods emission --footprints 2", 1, "no method of this study has footprints to sweep");
  check(kStudySmoke + "-o r --methods dos --scales 1", 1, "no method of this study has windows");
  check(kStudySmoke + "-o r --scales 0", 1, "scales: is 0, must be in [0.015625, 64]");
  check(kStudySmoke + "-o r --directions 1025", 1, "directions: is 1025, must be in [1, 1024]");
  check(kStudySmoke + "-o r --slices 1", 1, "slices: 1 are too few: ");
  check("study none.json -o r", 1, "none.json");
  check(kStudySmoke + "-o r --compare none.json", 1, "none.json");
  fs::create_directory(folder.path() / "other");
  writeBytes(folder.path() / "other" / "letter.txt", "dear");
  check(kStudySmoke + "--quick -o other", 1, "other: holds files but no study.json");
  CHECK(std::distance(fs::directory_iterator(folder.path() / "other"), fs::directory_iterator()) == 1);
}
