// Outputs that are no plain new files, of the commands that need OpenGL.
// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <string>

#include "support/gl_fixture.h"
#include "tools/ball_workplace.h"
#include "tools/ended.h"
#include "tools/refusal.h"

using namespace umbrick;
using Catch::Contains;
using Catch::StartsWith;
namespace fs = std::filesystem;

namespace {
const std::string kRender = "render ball.vdb --tf ball.json --size 24x20 --azimuth 0 --up z ";
const std::string kStudy = "study ball.vdb --tf ball.json --azimuth 0 --up z --size 32x32 --quick ";
}  // namespace

TEST_CASE("A rendered picture goes to stdout with -, whole and once", "[tools]") {
  if (!testContext()) return;
  const BallWorkplace at;
  REQUIRE(at.run(kRender + "-o a.png").status == 0);
  const ProgramResult out = at.run(kRender + "-o -");
  CHECK(out.status == 0);
  CHECK((out.out == readBytes(at.folder.path() / "a.png")));
  // A picture that gets better while it is made is written when it is done.
  const ProgramResult passes =
      at.run(kRender + "--model cone --progressive 6 --seed 7 --format exr -o - --stats s.json");
  CHECK(passes.status == 0);
  CHECK_THAT(passes.out, StartsWith("v/1\x01"));
  writeBytes(at.folder.path() / "b.exr", passes.out);
  CHECK(at.exr("b.exr").layers[0].image.width == 24);
  CHECK_THAT(at.run(kRender + "-o a.png --stats -").out, StartsWith("{\n"));
}

TEST_CASE("A full device is an error of render, check and study", "[tools]") {
  if (!testContext()) return;
  const BallWorkplace at;
  const std::string full = "/dev/full: cannot write: No space left on device";
  CHECK_THAT(at.run(kRender + "-o /dev/full").err, Contains(full));
  REQUIRE(at.run(kRender + "-o a.png").status == 0);
  const ProgramResult stats = at.run(kRender + "-o a.png --stats /dev/full");
  CHECK(stats.status == 1);
  CHECK_THAT(stats.err, Contains(full));
  const ProgramResult check =
      runShell(at.folder, "$umbrick check ball.vdb --tf ball.json --edges 8 --slices 1 > /dev/full");
  CHECK(check.status == 1);
  CHECK_THAT(check.err, Contains("stdout: cannot write: No space left on device"));
  expectRefusal(at.folder, kStudy + "-o -", 2, "--output: expected a folder, since a study is many files, found -");
  fs::create_directory(at.folder.path() / "report");
  writeBytes(at.folder.path() / "report/study.json", "{}");
  fs::permissions(at.folder.path() / "report/study.json", fs::perms(0444));
  expectRefusal(at.folder, kStudy + "-o report", 1, "study.json: cannot write: is read-only; --force replaces it");
}

TEST_CASE("A check stops at a signal, and prints what it has measured", "[tools]") {
  if (!testContext()) return;
  const BallWorkplace at;
  const auto begin = std::chrono::steady_clock::now();
  const auto later = [&] { return std::chrono::steady_clock::now() - begin > std::chrono::seconds(2); };
  const Ended check = endProgram(at.folder, "check ball.vdb --tf ball.json --size 512x512 --edges 8 16 32 --slices 100",
                                 SIGTERM, later);
  CHECK(check.seconds < kMostSeconds);  // with what it prints of the laws that are measured, and the end of OpenGL
  CHECK(check.result.status != 0);
}
