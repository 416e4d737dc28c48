// What is kept when the user stops a picture or a check.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "support/gl_fixture.h"
#include "tools/interrupt.h"

using namespace umbrick;
using Catch::Contains;
using Catch::EndsWith;

namespace {

// A job that tells its steps at once says when it is far enough to be stopped.
const std::string kTellingSteps = "env UMBRICK_PROGRESS=steps sh .run";

std::function<bool()> hasSaid(const TemporaryFolder& folder, const std::string& text) {
  return [&folder, text] { return readBytes(folder.path() / ".err").find(text) != std::string::npos; };
}

}  // namespace

TEST_CASE("A picture that is interrupted leaves no file and says so", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  const ProgramResult result =
      interruptProgram(folder, "render " + kSmoke + "--tf smoke --size 512x512 --repeat 1000000 -o a.png",
                       hasSaid(folder, "rendering: "), kTellingSteps);
  CHECK(result.status == 1);
  CHECK(result.out.empty());
  CHECK_THAT(result.err, Contains("umbrick: interrupted; nothing was written\n"));
  CHECK(filesIn(folder) == 0);
}

TEST_CASE("A progressive picture that is interrupted keeps the samples that are done", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  const ProgramResult result = interruptProgram(
      folder, "render " + kSmoke + "--tf smoke --model cone --size 64x64 --progressive 1000000 -o a.png",
      [&] { return std::filesystem::exists(folder.path() / "a.png"); });
  CHECK(result.status == 1);
  CHECK(result.out == "a.png\n");
  CHECK_THAT(result.err, Contains("umbrick: interrupted after ") && Contains("the picture has these\n"));
  CHECK(filesIn(folder) == 1);
}

TEST_CASE("A check that is interrupted tells the invariants that it has measured", "[tools][slow]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  const ProgramResult result =
      interruptProgram(folder, "check " + kSmoke + "--tf smoke --size 256x256 --edges 8 16 --slices 4",
                       hasSaid(folder, " cone"), kTellingSteps);  // not every step is told
  CHECK(result.status == 1);
  const auto rowOf = [&](const std::string& name) {
    const std::size_t at = result.out.find(name);
    REQUIRE(at != std::string::npos);
    return result.out.substr(at, result.out.find('\n', at) - at);
  };
  CHECK_THAT(rowOf("aprons equal the neighbours' voxels"), EndsWith("ok"));
  CHECK_THAT(rowOf("bricked equals unbricked, emission"), EndsWith("ok"));
  CHECK_THAT(rowOf("bricked equals unbricked, cone"), Contains("not "));
  CHECK_THAT(result.err, Contains("umbrick: interrupted: ") && Contains(" invariants are measured, the rest is not\n"));
}
