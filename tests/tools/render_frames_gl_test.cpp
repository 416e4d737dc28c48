// Pictures of a sequence, and of a camera that moves around one volume.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/gl_fixture.h"
#include "tools/frames_workplace.h"
#include "tools/interrupt.h"
#include "tools/program.h"
#include "tools/refusal.h"
#include "umbrick/core/srgb.h"
#include "umbrick/image/exr.h"
#include "umbrick/image/png.h"

using namespace umbrick;
namespace fs = std::filesystem;
using Catch::Contains;

TEST_CASE("A frame of a sequence is the picture that its scene makes of its file alone", "[tools]") {
  const FramesWorkplace at;
  for (const int n : {1, 2, 3, 4}) at.addFrame(n);
  const auto check = [&](const std::string& backend) {
    CAPTURE(backend);
    const ProgramResult all = at.render("f_%02d.nrrd " + kSeen + backend + "--overwrite --frames 1-4 -o o_%d.exr");
    CHECK(all.out == "o_1.exr\no_2.exr\no_3.exr\no_4.exr\n");
    for (const int n : {1, 3, 4}) {
      const std::string name = "o_" + std::to_string(n) + ".exr";
      CHECK_THAT(at.sceneOf(name).at("volume").at("file").get<std::string>(), Contains("f_0" + std::to_string(n)));
      // The header of a frame is a scene that makes it again.
      writeBytes(at.folder.path() / "s.json", at.sceneOf(name).dump());
      at.render("s.json --exr-pixel float " + backend + "-o one.exr");
      CHECK((at.pixels(name) == at.pixels("one.exr")));
    }
    CHECK((at.pixels("o_1.exr") != at.pixels("o_4.exr")));
  };
  check("--backend cpu ");
  if (testContext()) check("--backend osmesa --model cone --method ordinates ");
}

TEST_CASE("All frames have one transfer function and one camera, which suit the largest of them", "[tools]") {
  const FramesWorkplace at;
  for (const int n : {1, 2, 3, 4, 5}) at.addFrame(n);
  const ProgramResult all = at.render("f_%02d.nrrd --backend cpu --size 16x16 -o o_%d.exr");
  CHECK_THAT(all.err, Contains("by frame 5, whose values reach farthest of 1, 3 and 5"));
  const nlohmann::json first = at.sceneOf("o_1.exr");
  for (const char* name : {"o_2.exr", "o_3.exr", "o_4.exr", "o_5.exr"}) {
    CHECK(at.sceneOf(name).at("transfer") == first.at("transfer"));
    CHECK(at.sceneOf(name).at("camera") == first.at("camera"));
  }
  // The same function that the last one would have alone.
  at.render("f_05.nrrd --backend cpu --size 16x16 -o one.exr");
  CHECK(at.sceneOf("one.exr").at("transfer") == first.at("transfer"));
}

TEST_CASE("A still camera and a still volume give equal frames bit for bit", "[tools]") {
  const FramesWorkplace at;
  for (const int n : {1, 2, 3}) at.addVolume(n, ball(4, 200));
  const auto check = [&](const std::string& backend) {
    CAPTURE(backend);
    at.render("f_01.nrrd " + kSeen + backend + "--count 3 --overwrite -o c_%d.exr -o c_%d.png");
    at.render("f_%02d.nrrd " + kSeen + backend + "--overwrite -o s_%d.exr");
    for (const char* name : {"c_1.exr", "c_2.exr", "s_1.exr", "s_2.exr", "s_3.exr"})
      CHECK((at.pixels(name) == at.pixels("c_0.exr")));
    CHECK((readBytes(at.folder.path() / "c_1.png") == readBytes(at.folder.path() / "c_0.png")));
  };
  check("--backend cpu ");
  check("--backend cpu --technique shear-warp ");
  if (!testContext()) return;
  check("--backend osmesa --model emission ");
  check("--backend osmesa --model cone --method dos ");
}

TEST_CASE("An orbit goes around the volume as the azimuth does", "[tools]") {
  const FramesWorkplace at;
  at.addFrame(4);
  at.render("f_04.nrrd " + kSeen + "--backend cpu --count 4 --orbit -360 -o o_%d.exr --annotate triad -o o_%d.png");
  for (const int n : {0, 1, 2, 3}) {
    const std::string azimuth = "--azimuth " + std::to_string(20 - 90 * n);
    at.render(
        "f_04.nrrd --tf t.json --size 40x30 --elevation 10 --zoom 1 --exr-pixel float --backend cpu --annotate "
        "triad -o one.exr -o one.png " +
        azimuth);
    // The cameras differ by rounding, so that a sample may fall to the other side of a step by far less than this.
    CHECK(largestDifference(at.pixels("o_" + std::to_string(n) + ".exr"), at.pixels("one.exr")) < 1e-4);
    CHECK(largestDifference(at.pixels("o_" + std::to_string(n) + ".png"), at.pixels("one.png")) <
          0.02);  // a step of 8 bits
  }
  // Steps of a turn of one degree change a picture by less than those of ten: nothing jumps.
  at.render("f_04.nrrd " + kSeen + "--backend cpu --count 8 --orbit 8 -o d_%d.exr");
  at.render("f_04.nrrd " + kSeen + "--backend cpu --count 2 --orbit 20 -o t_%d.exr");
  const double ten = largestDifference(at.pixels("t_0.exr"), at.pixels("t_1.exr"));
  for (int n = 1; n < 8; ++n)
    CHECK(largestDifference(at.pixels("d_" + std::to_string(n - 1) + ".exr"),
                            at.pixels("d_" + std::to_string(n) + ".exr")) < 0.5 * ten + 1e-4);
}

TEST_CASE("A job goes on where it ended, and draws all again when it is told to", "[tools]") {
  const FramesWorkplace at;
  for (const int n : {1, 2, 3, 4}) at.addFrame(n);
  const std::string job = "f_%02d.nrrd --backend cpu " + kSeen + "-o o_%d.png -o o_%d.exr ";
  at.render(job);
  const std::string before = readBytes(at.folder.path() / "o_1.exr");
  fs::remove(at.folder.path() / "o_2.png");
  fs::remove(at.folder.path() / "o_4.exr");
  const ProgramResult rest = at.render(job);
  CHECK(rest.out == "o_2.png\no_2.exr\no_4.png\no_4.exr\n");
  CHECK_THAT(rest.err, Contains("2 of 4 frames are there and stay: 1, 3; --overwrite draws all again\n"));
  CHECK(count(rest.err, "another scene") == 0);
  CHECK_THAT(at.render(job).err, Contains("4 of 4 frames are there and stay: 1 to 4"));
  fs::remove(at.folder.path() / "o_2.exr");
  CHECK_THAT(at.render(job + "--model emission").err, Contains("o_1.exr: was drawn of another scene (/") &&
                                                          Contains(") and stays; --overwrite draws all again\n"));
  writeBytes(at.folder.path() / "o_1.exr", "not a picture");
  fs::remove(at.folder.path() / "o_2.exr");
  CHECK_THAT(at.render(job).err, Contains("o_1.exr: is no picture that can be read and stays"));
  writeBytes(at.folder.path() / "o_1.exr", "not a picture");
  CHECK(count(at.render(job + "--overwrite").out, "\n") == 8);
  CHECK((readBytes(at.folder.path() / "o_1.exr") == before));
}

TEST_CASE("Frames that are missing, damaged or unlike the first one end the job or are left out", "[tools]") {
  const FramesWorkplace at;
  for (const int n : {1, 2, 4, 6}) at.addFrame(n);
  const std::string job = "render f_%02d.nrrd --backend cpu " + kSeen + "-o o_%d.png ";
  expectRefusal(at.folder, job, 1, "f_%02d.nrrd: 2 frames are missing: 3, 5; --skip-missing goes on without them");
  at.addFrame(3, "1 1 2");
  writeBytes(at.folder.path() / "f_05.nrrd", header("dimension: 3\nsizes: 12 12 12\n") + "short");
  const ProgramResult stopped = at.run(job);
  CHECK(stopped.status == 1);
  CHECK_THAT(stopped.err, Contains("umbrick: frame 3: f_03.nrrd: its voxels are of another size than those of f_01.nrrd"
                                   "; --skip-missing goes on without it\n"));
  CHECK(at.has("o_2.png"));
  CHECK_FALSE(at.has("o_3.png"));
  const ProgramResult rest = at.run(job + "--skip-missing");
  CHECK(rest.status == 0);
  CHECK(rest.out == "o_4.png\no_6.png\n");
  CHECK_THAT(rest.err,
             Contains("frame 3: f_03.nrrd: its voxels are of another size than those of f_01.nrrd; left out\n") &&
                 Contains("frame 5: f_05.nrrd: "));
}

TEST_CASE("A frame that holds nothing is drawn empty", "[tools]") {
  const FramesWorkplace at;
  at.addVolume(1, std::string(kEdge * kEdge * kEdge, '\0'));
  at.addFrame(2);
  const ProgramResult all = at.render("f_%02d.nrrd --backend cpu " + kSeen + "-o o_%d.exr --layers --stats s_%d.json");
  CHECK_THAT(all.err, Contains("frame 1 holds nothing and is drawn empty\n"));
  const std::vector<float> blank = at.pixels("o_1.exr");
  CHECK(std::all_of(blank.begin(), blank.end(), [](float value) { return value == 0; }));
  CHECK(readExr(at.folder.path() / "o_1.exr").layers.size() == readExr(at.folder.path() / "o_2.exr").layers.size());
  CHECK(nlohmann::json::parse(readBytes(at.folder.path() / "s_1.json")).at("empty") == true);
}

TEST_CASE("Frames in one file are counted from 0", "[tools]") {
  const FramesWorkplace at;
  writeBytes(at.folder.path() / "four.nrrd",
             header("dimension: 4\nsizes: 12 12 12 3\nkinds: domain domain domain time\n") + ball(3, 90) +
                 ball(4, 150) + ball(5, 240));
  at.addVolume(2, ball(5, 240));
  at.render(
      "four.nrrd --backend cpu --eye 5 -30 5 --look-at 5 5 5 --tf t.json --exr-pixel float --size 24x24 --frames "
      "0-2:2 -o o_%d.exr --stats all.json");
  CHECK(at.has("o_0.exr"));
  CHECK_FALSE(at.has("o_1.exr"));
  at.render(
      "f_02.nrrd --backend cpu --eye 5 -30 5 --look-at 5 5 5 --tf t.json --exr-pixel float --size 24x24 -o one.exr");
  CHECK((at.pixels("o_2.exr") == at.pixels("one.exr")));
  const nlohmann::json stats = nlohmann::json::parse(readBytes(at.folder.path() / "all.json"));
  REQUIRE(stats.size() == 2);
  CHECK(stats.at(1).at("frame") == 2);
  CHECK(stats.at(1).at("time_ms").at("load") > 0);
  // A scene of one of them is no sequence.
  writeBytes(at.folder.path() / "one.json", R"({"volume": {"file": "four.nrrd", "grid": "[1]"}})");
  CHECK_THAT(at.run("render one.json -o n_%d.png").err, Contains("n_%d.png: expected a sequence"));
}

TEST_CASE("Several frames go to stdout one after another", "[tools]") {
  const FramesWorkplace at;
  at.addFrame(3);
  const ProgramResult out = at.render("f_03.nrrd --backend cpu " + kSeen + "--count 3 -o -");
  CHECK(count(out.out, "\x89PNG\r\n") == 3);
  CHECK(count(out.out, "IEND") == 3);
}

TEST_CASE("Frames that were drawn before an interrupt stay, and the job goes on behind them", "[tools]") {
  const FramesWorkplace at;
  at.addFrame(4);
  const std::string job =
      "render f_04.nrrd --backend cpu --tf t.json --size 200x200 --count 1000 --orbit 360 -o o_%03d.exr ";
  const ProgramResult result = interruptProgram(at.folder, job, [&] { return at.has("o_001.exr"); });
  CHECK(result.status == 1);
  CHECK_THAT(result.err,
             Contains("umbrick: interrupted after ") && Contains(" of 1000 frames; these are there: 0 to "));
  const std::size_t there = count(result.out, "\n");
  for (std::size_t n = 0; n < there; ++n) {
    char name[32];
    std::snprintf(name, sizeof name, "o_%03d.exr", static_cast<int>(n));
    CHECK(at.pixels(name).size() == 200 * 200 * 4);
  }
  CHECK(filesIn(at.folder) == there + 2);
}

TEST_CASE("What several pictures cannot be made of is refused in one line", "[tools]") {
  const FramesWorkplace at;
  for (const int n : {1, 2}) at.addFrame(n);
  const auto refused = [&](const std::string& arguments, int status, const std::string& message) {
    expectRefusal(at.folder, "render " + arguments, status, message);
  };
  refused("f_01.nrrd --frames 5 -o o.png", 2, "--repeat draws one picture several times, --count makes several");
  refused("f_01.nrrd -o o_%d.png", 2, "o_%d.png: expected a sequence, as 'smoke_%04d.vdb', or --count");
  refused("f_%02d.nrrd --frames 1-2 -o o.png", 2, "o.png: expected an output with a number in its name");
  refused("f_%02d.nrrd --frames 2-1 -o o_%d.png", 2, "--frames: expected A, A-B or A-B:step");
  refused("f_%02d.nrrd --frames 7-9 -o o_%d.png", 1, "f_%02d.nrrd: expected frames of 7-9, found none");
  refused("g_%02d.nrrd -o o_%d.png", 1, "g_%02d.nrrd: expected files of that pattern, found none");
  refused("f_%d_%d.nrrd -o o_%d.png", 2, "f_%d_%d.nrrd: expected one number in the name, as frame_%04d, found 2");
  refused("f_%02d.nrrd -o o_%d_%d.png", 2, "o_%d_%d.png: expected one number in the name, as frame_%04d, found 2");
  refused("f_01.nrrd --orbit 90 -o o.png", 2, "--orbit: expected several pictures");
  refused("f_%02d.nrrd --count 3 --frames 1-2 -o o_%d.png", 2, "--count and --frames exclude each other");
  refused("f_01.nrrd --count 3 --progressive 4 --model emission -o o_%d.png", 2, "are for one picture");
  refused("f_01.nrrd --count 3 --repeat 4 -o o_%d.png", 2, "--repeat: is for one picture");
  refused("f_01.nrrd --count 3 -o none/o_%d.png", 1, "none/o_0.png: cannot write");
  refused("f_01.nrrd --count 3 -o o_%d.png -o o_%d.png", 2, "named twice");
}
