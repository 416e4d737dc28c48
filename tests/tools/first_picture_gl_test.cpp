// The first picture: any input, no option, and what the program says about its choices.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/gl_fixture.h"
#include "tools/program.h"
#include "umbrick/image/exr.h"

using namespace umbrick;
using Catch::Contains;

namespace {

constexpr int kEdge = 24;
const std::string kDims = "--dims 24 24 24 --type u8 ";

// Writes a ball of `inside` in 0, one byte a voxel.
void writeBall(const std::filesystem::path& path, int inside) {
  std::ofstream out(path, std::ios::binary);
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x) {
        const double r = std::sqrt((x - 12.) * (x - 12.) + (y - 12.) * (y - 12.) + (z - 12.) * (z - 12.));
        out.put(static_cast<char>(std::clamp((9 - r) * 40 + 60, 0.0, double(inside))));
      }
}

// Takes the options out of "file: --tf auto ... (reasons)".
std::string chosenOptions(const std::string& line) {
  const std::size_t begin = line.find(" --"), end = line.find(" (");
  REQUIRE(begin != std::string::npos);
  return line.substr(begin, end == std::string::npos ? end : end - begin);
}

float mostAlpha(const std::filesystem::path& path) {
  const ExrFile file = readExr(path);
  float most = 0;
  for (std::size_t i = 3; i < file.layers[0].image.pixels.size(); i += 4)
    most = std::max(most, file.layers[0].image.pixels[i]);
  return most;
}

}  // namespace

TEST_CASE("Any input is drawn without an option, and the line that says how draws it again", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  writeBall(folder.path() / "ball.raw", 200);
  writeBall(folder.path() / "f_01.raw", 200);
  writeBall(folder.path() / "f_02.raw", 100);
  REQUIRE(runProgram(folder, "convert ball.raw " + kDims + "-o ball.nrrd").status == 0);
  REQUIRE(runProgram(folder, "convert ball.raw " + kDims + "--isosurface 100 -o surface.vdb").status == 0);
  const std::string size = "--size 32x32 --exr-pixel float ";
  for (const std::string& input :
       {"ball.raw " + kDims, std::string("ball.nrrd "), std::string("surface.vdb "), "'f_%02d.raw' " + kDims, kSmoke}) {
    CAPTURE(input);
    const ProgramResult first = runProgram(folder, "render " + input + size + "-o a.exr");
    CAPTURE(first.err);
    REQUIRE(first.status == 0);
    CHECK(std::count(first.err.begin(), first.err.end(), '\n') == 1);
    for (const char* chosen : {"--tf auto", "--model cone", "--quality normal", "--up", "--azimuth 30"})
      CHECK_THAT(first.err, Contains(chosen));
    CHECK(mostAlpha(folder.path() / "a.exr") > 0.9f);
    const ProgramResult again = runProgram(folder, "render " + input + size + chosenOptions(first.err) + " -o b.exr");
    REQUIRE(again.status == 0);
    const ExrFile a = readExr(folder.path() / "a.exr"), b = readExr(folder.path() / "b.exr");
    CHECK(a.layers[0].image.pixels == b.layers[0].image.pixels);
    // The scene in the header knows where the voxels come from, however they were described.
    std::ofstream(folder.path() / "again.json") << a.metadata.at("umbrick.scene");
    REQUIRE(runProgram(folder, "render again.json --exr-pixel float -o c.exr").status == 0);
    CHECK(readExr(folder.path() / "c.exr").layers[0].image.pixels == a.layers[0].image.pixels);
  }
}

TEST_CASE("The suggested function can be written, edited and used", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  const std::string size = "--size 32x32 --exr-pixel float ";
  const ProgramResult made = runProgram(folder, "tf auto " + kSmoke + "-o tf.json");
  CHECK(made.status == 0);
  CHECK(made.out == "tf.json\n");
  CHECK_THAT(made.err, Contains("fog"));
  CHECK(nlohmann::json::parse(runProgram(folder, "tf auto " + kSmoke).out).contains("points"));
  CHECK(nlohmann::json::parse(runProgram(folder, "info --suggest-tf " + kSmoke).out).contains("points"));
  // Without a function named heat would glow, too.
  REQUIRE(runProgram(folder, "render " + kSmoke + size + "--emission-grid none -o a.exr").status == 0);
  REQUIRE(runProgram(folder, "render " + kSmoke + size + "--tf tf.json -o b.exr").status == 0);
  CHECK(readExr(folder.path() / "a.exr").layers[0].image.pixels ==
        readExr(folder.path() / "b.exr").layers[0].image.pixels);
  const ProgramResult list = runProgram(folder, "tf list -o sheet.png");
  CHECK(list.status == 0);
  for (const char* preset : {"cloud", "ct-bone", "ct-head", "explosion", "fire", "grey-ramp", "smoke"})
    CHECK_THAT(list.out, Contains(preset));
  CHECK(std::filesystem::file_size(folder.path() / "sheet.png") > 1000);
}

TEST_CASE("A picture of nothing says what the volume holds and what to try", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  writeBall(folder.path() / "ball.raw", 200);
  const std::string ball = "render ball.raw " + kDims + "--size 24x24 ";
  const ProgramResult none = runProgram(folder, ball + "--azimuth 0 --tf ct-bone -o a.png");
  CHECK(none.status == 0);
  CHECK_THAT(none.err,
             Contains("nothing is drawn") && Contains("to 200") && Contains("above 1130") && Contains("--tf auto"));
  CHECK(runProgram(folder, ball + "--azimuth 0 --tf ct-bone --strict -o a.png").status == 1);
  CHECK(runProgram(folder, ball + "--azimuth 0 --tf ct-bone --background 1 1 1 --strict -o a.png").status == 1);
  const ProgramResult full = runProgram(folder, ball + "--tf auto --zoom 40 -o a.png");
  CHECK_THAT(full.err, Contains("every pixel is opaque") && Contains("--zoom 0.5"));
  const ProgramResult seen = runProgram(folder, ball + "--azimuth 0 --strict -o a.png");
  CHECK(seen.status == 0);
  CHECK_THAT(seen.err, !Contains("nothing"));
}

TEST_CASE("Views go by name, and what cannot be looked at so is refused", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  writeBall(folder.path() / "ball.raw", 200);
  const std::string ball = "render ball.raw " + kDims + "--size 24x24 -o a.png --stats a.json ";
  const auto refused = [&](const std::string& options, const std::string& message) {
    CAPTURE(options);
    const ProgramResult result = runProgram(folder, ball + options);
    CHECK(result.status == 2);
    CHECK_THAT(result.err, Contains(message));
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  };
  REQUIRE(runProgram(folder, ball + "--view right --up y").status == 0);
  const auto camera = nlohmann::json::parse(readBytes(folder.path() / "a.json"))["scene"]["camera"];
  CHECK(camera["eye"][0].get<double>() > 20);  // y is up, the front is +z: the right side is +x
  CHECK(camera["up"][1].get<double>() == Approx(1));
  REQUIRE(runProgram(folder, ball + "--azimuth 20 --up -y --pan 0.1 0 --zoom 2").status == 0);
  refused("--view anterior", "the volume does not state its anatomy");
  refused("--view sideways", "expected one of front, back");
  refused("--view front --azimuth 3", "exclude each other");
  refused("--view front --eye 0 0 0 --look-at 1 1 1", "--eye excludes --view");
  refused("--up 0 0 1", "three numbers need --eye");
  refused("--up q", "--up: expected one of");
  const ProgramResult parallel = runProgram(folder, ball + "--up y --front y");
  CHECK(parallel.status == 1);
  CHECK_THAT(parallel.err, Contains("--front: is 'y', must be at right angles to upAxis 'y'"));
  CHECK(runProgram(folder, ball + "--eye 90 12 12 --look-at 12 12 12 --up 0 1 0").status == 0);
  CHECK(runProgram(folder, ball + "--eye 90 12 12 --look-at 12 12 12 --up -y").status == 0);
}

TEST_CASE("Inputs that nothing reads are refused in one line with what helps", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "text.dat") << "no volume\n";
  const auto refused = [&](const std::string& arguments, const std::string& message) {
    CAPTURE(arguments);
    const ProgramResult result = runProgram(folder, "render " + arguments + " -o a.png");
    CHECK((result.status == 1 || result.status == 2));
    CHECK_THAT(result.err, Contains(message));
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK_FALSE(std::filesystem::exists(folder.path() / "a.png"));
  };
  refused("text.dat", "--dims and --type");
  refused("text.dat --dims 4 4 4", "needs --dims and --type");
  refused("text.dat --dims 4 4 4 --type u8", "64");
  refused(kSmoke + "--dims 4 4 4 --type u8", "for headerless raw");
  refused(kSmoke + "--grid none", "no grid \"none\"");
  refused("none_%04d.nrrd", "none_%04d.nrrd");
  refused("missing.nrrd", "missing.nrrd");
  for (const auto& [text, message] :
       {std::pair("{\"points\": []}", "at least one point"), std::pair("{\"points\": [{\"value\": NaN}]}", "tf.json"),
        std::pair("", "tf.json")}) {
    std::ofstream(folder.path() / "tf.json") << text;
    refused(kSmoke + "--tf tf.json", message);
  }
}
