// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/gl_fixture.h"
#include "support/test_scenes.h"
#include "tools/program.h"
#include "umbrick/image/exr.h"
#include "umbrick/image/png.h"

using namespace umbrick;
namespace fs = std::filesystem;
using Catch::Contains;
using Catch::StartsWith;

namespace {

const std::string kSmall = kSmoke + "--grid density --tf smoke --size 40x30 --up z ";

void writeText(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

}  // namespace

TEST_CASE("A picture can be made again from the scene in its EXR header", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  const ProgramResult first =
      runProgram(folder, "render " + kSmall +
                             "--model cone --azimuth 40 --elevation 20 --clip-plane 1 0 0 3 --layers --exr-pixel float "
                             "-o a.exr -o a.png --stats a.json");
  CHECK(first.err.empty());
  REQUIRE(first.status == 0);
  CHECK(first.out == "a.exr\na.png\n");
  const ExrFile a = readExr(folder.path() / "a.exr");
  REQUIRE(a.layers.size() == 3);
  CHECK(a.layers[0].image.width == 40);
  CHECK(a.layers[0].image.height == 30);
  writeText(folder.path() / "again.json", a.metadata.at("umbrick.scene"));
  REQUIRE(runProgram(folder, "render again.json --layers --exr-pixel float -o b.exr").status == 0);
  const ExrFile b = readExr(folder.path() / "b.exr");
  for (std::size_t i = 0; i < a.layers.size(); ++i) CHECK(a.layers[i].image.pixels == b.layers[i].image.pixels);

  // Something is seen, and the PNG shows the same to 8 bits.
  const Image png = readPng(folder.path() / "a.png");
  const Image& exr = a.layers[0].image;
  float most = 0, worst = 0;
  for (std::size_t i = 3; i < exr.pixels.size(); i += 4) {
    most = std::max(most, exr.pixels[i]);
    worst = std::max(worst, std::abs(exr.pixels[i] - png.pixels[i]));
  }
  CHECK(most > 0.5f);
  CHECK(worst <= 0.5f / 255 + 1e-6f);

  const auto stats = nlohmann::json::parse(readBytes(folder.path() / "a.json"));
  CHECK(stats["bricks"]["visible"] > 0);
  CHECK(stats["fragments_shaded"] > 0);
  CHECK(stats["technique"] == "rays");
  CHECK_THAT(stats["renderer"], StartsWith("CPU: "));
  for (const char* stage : {"load", "brick", "geometry", "upload", "sweep", "read", "write"})
    CHECK(stats["time_ms"][stage] >= 0);
  CHECK(stats["bytes"]["peak_memory"] > 0);
}

TEST_CASE("Every quality is drawn on the CPU, and what is of slices alone is said to be", "[tools]") {
  const TemporaryFolder folder;
  for (const std::string quality : {"draft", "normal", "high"}) {
    const ProgramResult result = runProgram(
        folder, "render " + kSmall + "--model cone --backend cpu --quality " + quality + " --stats s.json -o a.png");
    CAPTURE(quality, result.err);
    CHECK(result.status == 0);
    const auto stats = nlohmann::json::parse(readBytes(folder.path() / "s.json"));
    CHECK(stats["technique"] == "rays");
    CHECK(stats["light"]["directions"] > 0);
    CHECK(stats["scene"]["technique"] == "rays");
  }
  const ProgramResult told = runProgram(folder, "render " + kSmall + "--eye-bits 16 --technique shear-warp -o a.png");
  CHECK(told.status == 0);
  CHECK_THAT(told.err, Contains("--eye-bits has no effect on the CPU"));
}

TEST_CASE("Rays on OpenGL are drawn where they are asked for", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  const auto pictureOf = [&](const std::string& options) {
    const ProgramResult result =
        runProgram(folder, "render " + kSmall + options + " --saturation 0 --stats s.json -o a.exr");
    CAPTURE(options, result.err);
    REQUIRE(result.status == 0);
    return readExr(folder.path() / "a.exr").layers[0].image;
  };
  for (const std::string model : {"emission", "cone --quality draft --method light-volume"}) {
    const Image rays = pictureOf("--model " + model + " --technique rays --backend osmesa");
    const auto stats = nlohmann::json::parse(readBytes(folder.path() / "s.json"));
    CHECK(stats["technique"] == "rays");
    CHECK_THAT(stats["renderer"], StartsWith("OSMesa"));
    CHECK(stats["fragments_shaded"] > 0);
    CHECK(maxDifference(rays, pictureOf("--model " + model + " --technique slices --backend osmesa")) < 1e-3);
  }
  const ProgramResult told =
      runProgram(folder, "render " + kSmall +
                             "--model cone --quality draft --eye-bits 16 --technique rays --backend osmesa -o a.png");
  CHECK(told.status == 0);
  CHECK_THAT(told.err, Contains("--eye-bits has no effect on rays"));
}

TEST_CASE("Light volumes are swept by OpenGL where it is asked for, and the picture stays", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  const std::string lit =
      "render " + kSmall +
      "--azimuth 40 --elevation 20 --model cone --quality draft --method light-volume --stats s.json -o a.exr ";
  const auto pictureBy = [&](const std::string& options, const std::string& engine) {
    const ProgramResult result = runProgram(folder, lit + options);
    CAPTURE(options, result.err);
    REQUIRE(result.status == 0);
    CHECK(result.err.empty());
    CHECK(nlohmann::json::parse(readBytes(folder.path() / "s.json"))["light"]["swept_by"] == engine);
    return readExr(folder.path() / "a.exr").layers[0].image;
  };
  // EXR keeps halves, which are 2^-11 apart.
  CHECK(maxDifference(pictureBy("--backend osmesa --light-sweep gl", "gl"), pictureBy("--backend osmesa", "cpu")) <
        6e-4);
  const ProgramResult coarse = runProgram(folder, lit + "--backend osmesa --light-sweep gl --light-spacing 2");
  CHECK(coarse.status == 0);
  CHECK_THAT(coarse.err, Contains("light is computed on the CPU: OpenGL computes it at every voxel alone"));
  CHECK_THAT(runProgram(folder, lit + "--backend cpu --light-sweep gl").err,
             Contains("--light-sweep has no effect on the CPU"));
}

TEST_CASE("Renders that fail say so in one line and leave nothing behind", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  const auto check = [&](const std::string& arguments, int status, const std::string& message) {
    CAPTURE(arguments);
    const std::size_t before = filesIn(folder);
    const ProgramResult result = runProgram(folder, "render " + arguments);
    CHECK(result.status == status);
    CHECK_THAT(result.err, Contains(message));
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK(result.out.empty());
    CHECK(filesIn(folder) == before);
  };
  check("none.vdb --tf smoke -o a.png", 1, "none.vdb: no such file");
  check(". --tf smoke -o a.png", 1, "expected a file, found a directory");
  check(kSmoke + "--grid smoke --tf smoke -o a.png", 1, "no grid \"smoke\"");
  check(kSmoke + "--grid 'density[1]' --tf smoke -o a.png", 1, "density");
  check(kSmoke + "--tf no-such-preset -o a.png", 1, "no such transfer function");
  check(kSmall + "-o none/a.png", 1, "none/a.png: cannot write");
  check(kSmall + "-o a.jpg", 2, "a.jpg: expected a picture that ends in .exr or .png");
  check(kSmall + "-o a.png --stats none/s.json", 1, "none/s.json: cannot write");
  check(kSmall + "-o a.png --theta 90", 1, "theta: is 90 degrees, must be in [0, 90)");
  check(kSmall + "-o a.png --spacing 0", 1, "spacing: is 0, must be above 0");
  check(kSmall + "-o a.png --spacing -1", 1, "spacing: is -1, must be above 0");
  check(kSmoke + "--tf smoke --size 0x9 -o a.png", 1, "size: is 0 x 9, must be at least 1 x 1");
  check(kSmoke + "--tf smoke --size 9 -o a.png", 2, "expected WIDTHxHEIGHT");
  check(kSmoke + "--tf smoke --azimuth 0 --grid density --size 99999x99999 --backend osmesa -o a.png", 1,
        "beyond the driver's limit");
  check(kSmoke + "--tf smoke --azimuth 0 --grid density --size 99999x99999 --backend cpu -o a.png", 1,
        "buffers of 99999 x 99999 pixels: needs ");
  check(kSmall + "-o a.png --technique shear-warp --backend osmesa", 1,
        "shear-warp does not run on OpenGL but on the CPU");
  check(kSmall + "-o a.png --model cone --method ordinates --technique rays --backend osmesa", 1,
        "ordinates is one of slices; rays take light from a light volume");
  check(kSmall + "-o a.png --technique slices --backend cpu", 1, "slices does not run on the CPU but on OpenGL");
  check(kSmall + "-o a.png --model cone --method ordinates --backend cpu", 1, "ordinates is one of slices");
  check(kSmall + "-o a.png --eye 0 0 0", 2, "--eye needs --look-at");
  check(kSmall + "-o a.png --model glow", 2, "--model");
  check(kSmall + "-o a.png --no-such-option", 2, "--no-such-option");
  writeText(folder.path() / "tf.json", "{\"points\": [\n  {\"value\": 1, \"albedo\": [1, 1, 1], \"sigma_t\": -2}]}");
  check(kSmoke + "--tf tf.json -o a.png", 1, "tf.json:2:48: points[0].sigma_t: expected a number >= 0, found -2");
  writeText(folder.path() / "scene.json", "{\"volume\": {\"file\": \"x.vdb\"},\n \"modle\": \"cone\"}");
  check("scene.json -o a.png", 1, "scene.json:2:");
  writeText(folder.path() / "broken.json", "{\"volume\": ");
  check("broken.json -o a.png", 1, "broken.json:1:");
}

TEST_CASE("All invariants hold on a bundled volume, and the status says so", "[tools]") {
  if (!testContext()) return;
  const TemporaryFolder folder;
  const ProgramResult result = runProgram(
      folder, "check " + kSmoke +
                  "--grid density --tf smoke --azimuth 0 --size 48x48 --spacing 1 --edges 8 16 --slices 4 --json");
  CHECK(result.err.empty());
  CHECK(result.status == 0);
  const auto report = nlohmann::json::parse(result.out);
  CHECK_THAT(report.dump(), Contains("passed"));
}
