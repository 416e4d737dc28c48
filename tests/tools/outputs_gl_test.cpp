// Outputs that are no plain new files, of the commands that need OpenGL.
// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>
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

TEST_CASE("Each signal stops a check, which prints what it has measured", "[tools]") {
  if (!testContext()) return;
  const BallWorkplace at;
  const std::size_t before = filesIn(at.folder);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    const Ended check = endProgram(
        at.folder, "check ball.vdb --tf ball.json --size 512x512 --edges 8 16 32 --slices 100", number, after(2));
    CAPTURE(number, check.result.err);
    CHECK(check.seconds < kMostSeconds);
    const bool stopped = check.result.status == 1;
    CHECK((stopped || check.result.status == 128 + number));  // the latter where a picture takes too long
    if (stopped) CHECK_THAT(check.result.err, Contains(" invariants are measured, the rest is not\n"));
    CHECK_THAT(check.result.err, Contains("umbrick: interrupted"));
    CHECK(filesIn(at.folder) == before);
  }
}

TEST_CASE("Each signal stops a study, which goes on where it was stopped", "[tools]") {
  if (!testContext()) return;
  const BallWorkplace at;
  const std::string command = "study ball.vdb --tf ball.json --azimuth 0 --up z --size 256x256 -o report";
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    const Ended study = endProgram(at.folder, command, number, after(3));
    CAPTURE(number, study.result.err);
    CHECK(study.seconds < kMostSeconds);
    CHECK((study.result.status == 1 || study.result.status == 128 + number));
    CHECK_THAT(study.result.err, Contains("interrupted") || Contains("the same command goes on"));
    // What is there is whole, and nothing is a temporary file.
    const fs::path report = at.folder.path() / "report";
    if (fs::exists(report / "study.json")) CHECK(at.json("report/study.json").contains("cases"));
    for (const auto& entry : fs::recursive_directory_iterator(report))
      CHECK_FALSE(entry.path().filename().string().starts_with("."));
  }
}

// The last thread of a process gives its memory back. At a low priority that takes a minute on a busy machine, and Mesa
// lowers that of a thread of its own.
TEST_CASE("No thread of the program has a lower priority than the program", "[tools]") {
  if (!testContext()) return;
  const BallWorkplace at;
  const pid_t program =
      startProgram(at.folder, "check ball.vdb --tf ball.json --size 512x512 --edges 8 16 32 --slices 100");
  const fs::path tasks = "/proc/" + std::to_string(program) + "/task";
  const auto threadsOfMesa = [&] {
    std::size_t found = 0;
    std::error_code gone;
    for (const auto& task : fs::directory_iterator(tasks, gone))
      found += readBytes(task.path() / "comm").find('$') != std::string::npos;
    return found;
  };
  for (const auto late = after(20); threadsOfMesa() == 0 && !late();)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  CHECK(waitpid(program, nullptr, WNOHANG) == 0);
  // A thread lowers its priority as it begins.
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  for (const auto& task : fs::directory_iterator(tasks)) {
    const auto thread = static_cast<id_t>(std::stol(task.path().filename().string()));
    CHECK(getpriority(PRIO_PROCESS, thread) == getpriority(PRIO_PROCESS, 0));
  }
  ::kill(program, SIGKILL);
  waitFor(program);
  takeResult(at.folder, 0);
}
