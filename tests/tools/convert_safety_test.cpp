// What a conversion leaves behind that is killed, interrupted or out of space.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "tools/interrupt.h"
#include "tools/program.h"

using namespace umbrick;
using Catch::Contains;

namespace {

const std::string kConvertHead = "convert " + kHead;

// Runs the program by way of a shell command that ends in its arguments. @return the shell's status
int runBy(const TemporaryFolder& folder, const std::string& how, const std::string& arguments) {
  const std::string at = folder.path().string();
  const int raw =
      std::system(("cd '" + at + "' && (" + how + " '" UMBRICK_PROGRAM "' " + arguments + ") >.out 2>.err").c_str());
  return exitStatus(raw);
}

}  // namespace

TEST_CASE("A conversion killed at any moment leaves the old file or the whole new one", "[tools]") {
  const TemporaryFolder folder;
  const std::string oldOnes = kConvertHead + "--clip-below 3000 -o a.vdb",
                    newOnes = kConvertHead + "--clip-below 2000 -o a.vdb";
  REQUIRE(runProgram(folder, oldOnes).status == 0);
  const std::string before = readBytes(folder.path() / "a.vdb");
  REQUIRE(runProgram(folder, kConvertHead + "--clip-below 2000 -o b.vdb").status == 0);
  const std::string voxels = runProgram(folder, "info b.vdb --json").out;
  const auto counted = [](const std::string& info) {
    const std::size_t at = info.find("\"active_voxels\"");
    return info.substr(at, info.find(',', at) - at);
  };
  for (const char* seconds : {"0.02", "0.05", "0.1", "0.15", "0.2", "0.25", "0.3", "0.4"}) {
    CAPTURE(seconds);
    runBy(folder, std::string("timeout -s KILL ") + seconds, newOnes);
    if (readBytes(folder.path() / "a.vdb") == before) continue;
    const ProgramResult info = runProgram(folder, "info a.vdb --json");
    REQUIRE(info.status == 0);
    CHECK(counted(info.out) == counted(voxels));
  }
}

TEST_CASE("A disk that is full leaves the old file and nothing beside it", "[tools]") {
  const TemporaryFolder folder;
  REQUIRE(runProgram(folder, kConvertHead + "--clip-below 3000 -o a.vdb").status == 0);
  const std::string before = readBytes(folder.path() / "a.vdb");
  // Files may grow to 64 blocks of 512 or 1024 bytes, then a write fails as on a full disk.
  CHECK(runBy(folder, "trap '' XFSZ; ulimit -f 64;", kConvertHead + "-o a.vdb") == 1);
  const std::string err = readBytes(folder.path() / ".err");
  CHECK_THAT(err, Contains("a.vdb: cannot write: "));
  CHECK(std::count(err.begin(), err.end(), '\n') == 1);
  CHECK(readBytes(folder.path() / "a.vdb") == before);
  CHECK(filesIn(folder) == 3);  // with what the program printed
}

TEST_CASE("An interrupted conversion says so, fails and leaves nothing", "[tools]") {
  const TemporaryFolder folder;
  // Minutes of work.
  const ProgramResult result = interruptProgram(folder, "convert /dev/zero --dims 4000 4000 4000 --type u8 -o a.vdb");
  CHECK(result.status == 1);
  CHECK_THAT(result.err, Contains("a.vdb: interrupted before it was written"));
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  CHECK(filesIn(folder) == 0);
}

TEST_CASE("A terminal is shown the share, the rate and the time left, each pass by itself", "[tools]") {
  const TemporaryFolder folder;
  // script(1) gives the program a terminal and writes down what appears there.
  const auto seen = [&] { return readBytes(folder.path() / "seen"); };
  const ProgramResult result = interruptProgram(
      folder, "convert /dev/zero --dims 4000 4000 4000 --type u8 -o a.vdb",
      [&] { return seen().find(" left") != std::string::npos; },
      "env -u UMBRICK_PROGRESS script -q -e -f -c 'sh .run' seen");
  CHECK(result.status == 1);
  CHECK_THAT(seen(), Catch::Matches("[^]*converting zero \\[#*[.]*\\] +[0-9]+ %, [0-9]+ MB/s, [0-9:]+ left[^]*"));
  CHECK_THAT(seen(), Contains("a.vdb: interrupted before it was written"));
}

TEST_CASE("The number of threads does not change a file's content", "[tools]") {
  const TemporaryFolder folder;
  REQUIRE(runProgram(folder, kConvertHead + "--tolerance 20 --threads 1 -o a.vdb").status == 0);
  REQUIRE(runProgram(folder, kConvertHead + "--tolerance 20 --threads 3 -o b.vdb").status == 0);
  const auto described = [&](const char* file) {
    std::string info = runProgram(folder, std::string("info ") + file).out;
    return info.substr(info.find("grid"));
  };
  CHECK(described("a.vdb") == described("b.vdb"));
  CHECK(runProgram(folder, kConvertHead + "--threads -1 -o c.vdb").status == 2);
}
