// What the program does with less memory than it needs: one line, and no signal.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "support/gl_fixture.h"
#include "support/sanitized.h"
#include "tools/ball_workplace.h"

using namespace umbrick;
using Catch::Contains;

namespace {

// Runs the program with so much address space, MiB.
ProgramResult runWithin(const BallWorkplace& at, int mebibytes, const std::string& arguments) {
  const std::string shell = "cd '" + at.folder.path().string() + "' && (ulimit -v " + std::to_string(mebibytes * 1024) +
                            "; UMBRICK_PROGRESS=none exec '" UMBRICK_PROGRAM "' " + arguments + ") >.out 2>.err";
  return takeResult(at.folder, std::system(shell.c_str()));
}

// 24 limits from too small to load the libraries to ample, MiB.
constexpr auto kManyLimits = {50,  80,  100, 110, 120, 130, 140, 150, 160, 170, 180, 190,
                              200, 220, 260, 300, 350, 400, 450, 500, 550, 600, 650, 700};

// Tries commands under limits, each in one folder, whose files are all that is there after it was refused.
void checkLimits(const BallWorkplace& at, const std::string& arguments, std::initializer_list<int> limits) {
  if (kSanitized) return;  // the address sanitizer reserves terabytes of address space
  const std::size_t files = filesIn(at.folder);
  for (const int limit : limits) {
    const ProgramResult result = runWithin(at, limit, arguments);
    CAPTURE(arguments, limit, result.status, result.out, result.err);
    if (result.status == 0 || result.status == 127) continue;  // 127: the dynamic linker had not enough
    CHECK(result.status == 1);
    // A line may stand before it that says what was chosen.
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') <= 2);
    CHECK_THAT(result.err, Contains("umbrick: ") && !Contains("std::bad_alloc"));
    CHECK(filesIn(at.folder) == files);
  }
}

void checkLimits(const std::string& arguments, std::initializer_list<int> limits) {
  checkLimits(BallWorkplace(), arguments, limits);
}

}  // namespace

TEST_CASE("Commands without OpenGL take any limit of memory in one line", "[tools][memory]") {
  const auto limits = {130, 140, 150, 160, 170, 180, 200, 220, 260};
  checkLimits("convert ball.vdb --isosurface 0.5 -o a.vdb", limits);
  checkLimits("info ball.vdb --json", limits);
  checkLimits("reference ball.vdb --tf ball.json --size 16x16 -o a.exr", limits);
}

TEST_CASE("Pictures take any limit of memory in one line", "[tools][memory]") {
  if (!testContext()) return;
  checkLimits("render ball.vdb --tf ball.json --size 64x64 --backend osmesa -o a.exr",
              {200, 300, 350, 400, 450, 500, 550, 600, 650, 700, 800, 1000});
  checkLimits("render ball.vdb --tf ball.json --size 1500x1500 --model emission --backend osmesa -o a.exr",
              {500, 650, 700, 800, 1000});
  for (const std::string technique : {"rays", "shear-warp"})
    checkLimits("render ball.vdb --tf ball.json --size 900x900 --backend cpu --technique " + technique + " -o a.exr",
                {100, 150, 200, 230, 260, 300, 350, 400, 500});
}

TEST_CASE("Commands that look at volumes, functions and pictures take any limit of memory in one line",
          "[tools][memory]") {
  const BallWorkplace at;
  const std::string picture = "reference ball.vdb --tf ball.json --size 64x64 --azimuth 0 --up z --model emission -o ";
  for (const char* name : {"one.png", "one.exr"}) REQUIRE(at.run(picture + name).status == 0);
  checkLimits(at, "info ball.vdb --suggest-tf", kManyLimits);
  checkLimits(at, "tf auto ball.vdb", kManyLimits);
  checkLimits(at, "tf list -o /dev/null", kManyLimits);
  checkLimits(at, "compare one.png one.png --flip-map /dev/null", kManyLimits);
  checkLimits(at, "compare one.exr one.exr --difference /dev/null --json", kManyLimits);
}

TEST_CASE("A check and a study take any limit of memory in one line", "[tools][memory]") {
  if (!testContext()) return;
  const std::string scene = " ball.vdb --tf ball.json --azimuth 0 --up z --size 32x32 ";
  checkLimits("check" + scene + "--edges 8 --slices 1", kManyLimits);
  // A study that begins has a folder, with which it goes on; that it was refused at once leaves none.
  const std::string few = "--quick --methods emission --slices 8 --sizes 32 --segments 1 --bits 32 --repeats 1 ";
  checkLimits("study" + scene + few + "-o report", {50, 100, 130, 160, 200, 250, 300, 350, 400, 450, 500});
}

TEST_CASE("What would take more memory than there is, is refused before it is begun", "[tools][memory]") {
  if (kSanitized) return;
  const BallWorkplace at;
  const auto refused = [&](int limit, const std::string& arguments, const std::string& said) {
    const ProgramResult result = runWithin(at, limit, arguments);
    CAPTURE(arguments, result.err);
    CHECK(result.status == 1);
    CHECK_THAT(result.err, Contains(said) && Contains(" of memory, there is ") && Contains("ulimit -v"));
  };
  writeBytes(at.folder.path() / "thin.nhdr",
             "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 16 16 16\nencoding: raw\n"
             "spacings: 0.001 1 1\ndata file: thin.raw\n");
  std::string ball(16 * 16 * 16, '\0');
  for (std::size_t i = 0; i < ball.size(); ++i) {
    const auto square = [&](std::size_t at_) { return (double(at_ % 16) - 8) * (double(at_ % 16) - 8); };
    if (square(i) + square(i / 16) + square(i / 256) < 36) ball[i] = 100;
  }
  writeBytes(at.folder.path() / "thin.raw", ball);
  refused(900, "convert thin.nhdr --isosurface 50 -o a.vdb", "isosurface: a band of some ");
  refused(900, "convert thin.nhdr --resample 0.000001 0.001 1 -o a.vdb", "resample: a slice of ");
  refused(900, "reference ball.vdb --tf ball.json --size 20000x20000 -o a.exr", "a picture of 20000 x 20000 pixels");
  if (!testContext()) return;
  refused(900, "render ball.vdb --tf ball.json --size 16000x16000 -o a.exr", "buffers of 16000 x 16000 pixels");
}
