// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/program.h"
#include "umbrick/image/exr.h"

using namespace umbrick;
using Catch::Contains;
using Catch::Equals;
namespace fs = std::filesystem;

namespace {

std::size_t linesIn(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

Image flippedVertically(const Image& image) {
  Image flipped(image.width, image.height, image.channels);
  for (int y = 0; y < image.height; ++y)
    std::copy_n(image.at(0, y), image.width * image.channels, flipped.at(0, image.height - 1 - y));
  return flipped;
}

}  // namespace

TEST_CASE("A kit is exported, answered by this program and judged", "[tools]") {
  const TemporaryFolder folder;
  const ProgramResult made =
      runProgram(folder, "check " + kSmoke + "--grid density --tf smoke --size 24x18 --points 120 --export kit");
  INFO(made.err);
  REQUIRE(made.status == 0);
  CHECK(made.out == "kit\n");
  CHECK_THAT(made.err, Contains("1 case: ") && Contains("120 samples, 7 pictures with error bars of at most "));
  const fs::path kit = folder.path() / "kit", answers = kit / "answers" / "densityAndHeat";
  CHECK_THAT(readBytes(kit / "README.md"), Contains("| densityAndHeat | scene, face-on, diagonal, inside, "));

  const ProgramResult nothing = runProgram(folder, "check --against kit");
  CHECK(nothing.status == 1);
  CHECK(nothing.out ==
        "not answered: 8 questions: densityAndHeat (samples, scene, face-on, diagonal, inside, parallel-face-on, "
        "parallel-diagonal, parallel-slices-and-pixels-on-faces)\n");
  CHECK_THAT(nothing.err, Contains("kit: nothing is answered"));

  fs::create_directories(answers);
  REQUIRE(runProgram(folder,
                     "render kit/cases/densityAndHeat/scene.scene.json --exr-pixel float -o "
                     "kit/answers/densityAndHeat/scene.exr -o kit/answers/densityAndHeat/scene.unbricked.png")
              .status == 0);
  const ProgramResult right = runProgram(folder, "check --against kit");
  INFO(right.out);
  CHECK(right.status == 0);
  CHECK(right.err.empty());
  CHECK_THAT(right.out, Contains("the picture agrees with the reference") && Contains("bricked equals unbricked") &&
                            Contains("not answered: 7 questions") && !Contains("FAILED"));
  CHECK(linesIn(right.out) == 4);

  writeExr(answers / "scene.exr", {{"", flippedVertically(readExr(answers / "scene.exr").layers.front().image)}});
  fs::remove(answers / "scene.unbricked.png");
  writeBytes(answers / "sceen.exr", "misspelt");
  const ProgramResult wrong = runProgram(folder, "check --against kit");
  CHECK(wrong.status == 1);
  CHECK_THAT(wrong.out, Contains("FAILED") && Contains("   pixel (") &&
                            Contains("   hint: the picture agrees when it is flipped vertically"));
  CHECK(wrong.err == "answers/densityAndHeat/sceen.exr: no case asks for this file\n");
  const ProgramResult json = runProgram(folder, "check --against kit --json --tolerance 0.001");
  CHECK(json.status == 1);
  const auto parsed = nlohmann::json::parse(json.out);
  CHECK(parsed["passed"] == false);
  CHECK(parsed["verdicts"].size() == 8);
  CHECK(parsed["verdicts"][1]["outcome"] == "failed");
  CHECK(parsed["verdicts"][1]["limit"] == 0.001);
}

TEST_CASE("Options of kits that do not go together are refused, and nothing is written", "[tools]") {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "full");
  writeBytes(folder.path() / "full" / "mine", "");
  const auto refused = [&](const std::string& arguments, int status) {
    const ProgramResult result = runProgram(folder, "check " + arguments);
    CAPTURE(arguments, result.err);
    CHECK(result.status == status);
    CHECK(result.out.empty());
    CHECK(filesIn(folder) == 1);
    return result.err;
  };
  CHECK_THAT(refused("", 2), Contains("input is required"));
  CHECK_THAT(refused("--export kit --tf smoke", 2), Contains("--tf: goes with a volume"));
  CHECK_THAT(refused("--export kit --edges 8", 2), Contains("--edges: does not go with --export"));
  CHECK_THAT(refused("--export kit --against full", 2), Contains("--against"));
  CHECK_THAT(refused("--against full --points 20", 2), Contains("--points"));
  CHECK_THAT(refused(kSmoke + "--against full", 2), Contains("input: does not go with --against"));
  CHECK_THAT(refused("--export full", 1), Contains("full: holds files"));
  CHECK_THAT(refused("--against full", 1), Contains("expected a kit with a kit.json"));
  CHECK_THAT(refused(kSmoke + "--grid density --mode mip --export kit", 1),
             Equals("umbrick: mode (--mode): is mip, and a kit for other renderers has integrate alone\n"));
}
