// How soon a signal ends the program, and what it leaves then.
// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <random>
#include <string>
#include <vector>

#include "tools/ball_workplace.h"
#include "tools/ended.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

// Writes a transfer function of so many points, each of another medium than its neighbours.
void writeRough(const fs::path& path, int points) {
  std::mt19937 random(7);
  std::string text = "{\"points\": [";
  for (int i = 0; i < points; ++i)
    text += (i > 0 ? "," : "") + std::string("{\"value\":") + std::to_string(double(i) / points) +
            ",\"albedo\":[0.5,0.5,0.5],\"sigma_t\":" + std::to_string(random() % 100 / 50.0) + "}";
  writeBytes(path, text + "]}");
}

}  // namespace

TEST_CASE("Each signal ends a job that waits for a pipe within a second, and leaves nothing", "[tools][slow]") {
  const BallWorkplace at;
  REQUIRE(mkfifo((at.folder.path() / "p").c_str(), 0600) == 0);
  const std::size_t before = filesIn(at.folder);
  const std::string raw = " --dims 64 64 64 --type u8 ";
  const std::vector<std::string> commands{"convert p" + raw + "-o a.vdb",   "convert p" + raw + "-o a.mhd",
                                          "convert ball.vdb -o p",          "info p" + raw,
                                          "reference p" + raw + "-o a.png", "tf auto p" + raw + "-o a.json"};
  for (const int number : {SIGINT, SIGTERM, SIGHUP})
    for (const std::string& command : commands) {
      CAPTURE(command, number);
      const Ended ended = endProgram(at.folder, command, number, after(0.15));
      CHECK(ended.seconds < kMostSeconds);
      // On a busy machine it may not have come to the pipe yet, and then stops by itself.
      const bool stopped = ended.result.status == 1;
      CHECK((stopped || ended.result.status == 128 + number));
      CHECK_THAT(ended.result.err, Contains("interrupted"));
      CHECK(std::count(ended.result.err.begin(), ended.result.err.end(), '\n') == 1);
      CHECK(filesIn(at.folder) == before);
    }
}

TEST_CASE("Each signal ends a job of many steps within a second, and leaves nothing", "[tools]") {
  const BallWorkplace at;
  const std::size_t before = filesIn(at.folder);
  for (const int number : {SIGINT, SIGTERM, SIGHUP})
    for (const std::string format : {"vdb", "nvdb", "nrrd", "mhd"}) {
      CAPTURE(format, number);
      const Ended ended =
          endProgram(at.folder, "convert /dev/zero --dims 4000 4000 4000 --type u8 -o a." + format, number, after(0.1));
      CHECK(ended.seconds < kMostSeconds);
      CHECK(ended.result.status == 1);
      CHECK_THAT(ended.result.err, Contains("interrupted before it was written"));
      CHECK(filesIn(at.folder) == before);
    }
}

TEST_CASE("Each signal ends a look at a large volume or picture within a second", "[tools][slow]") {
  const BallWorkplace at;
  Image large(3000, 3000, 4);
  for (std::size_t i = 0; i < large.pixels.size(); ++i) large.pixels[i] = static_cast<float>(i % 251) / 251;
  writeExr(at.folder.path() / "large.exr", {{"", large}});
  const std::size_t before = filesIn(at.folder);
  const std::string endless = " /dev/zero --dims 4000 4000 4000 --type u8 ";
  const std::vector<std::string> commands{"tf auto" + endless + "-o a.json",
                                          "compare large.exr large.exr --flip-map a.png --difference a.exr"};
  for (const int number : {SIGINT, SIGTERM, SIGHUP})
    for (const std::string& command : commands) {
      CAPTURE(command, number);
      const Ended ended = endProgram(at.folder, command, number, after(0.4));
      CHECK(ended.seconds < kMostSeconds);
      CHECK(ended.result.status == 128 + number);  // these have no parts to keep
      CHECK(ended.result.err == "umbrick: interrupted\n");
      CHECK(ended.result.out.empty());
      CHECK(filesIn(at.folder) == before);
    }
}

TEST_CASE("A second signal ends the program at once", "[tools]") {
  const BallWorkplace at;
  REQUIRE(mkfifo((at.folder.path() / "p").c_str(), 0600) == 0);
  const pid_t program = startProgram(at.folder, "info p --dims 64 64 64 --type u8");
  while (!catchesInterrupt(program)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  for (int i = 0; i < 2; ++i) {
    ::kill(program, SIGTERM);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  CHECK(waitpid(program, nullptr, WNOHANG) == program);
  takeResult(at.folder, 0);
}

TEST_CASE("A signal that the program was told to ignore stays ignored", "[tools]") {
  const BallWorkplace at;
  REQUIRE(mkfifo((at.folder.path() / "p").c_str(), 0600) == 0);
  const ProgramResult result = runShell(
      at.folder,
      "trap '' HUP; $umbrick convert ball.vdb -o p --format nrrd & sleep 0.3; kill -HUP $!; cat p > got; wait $!");
  CHECK(result.status == 0);
  CHECK_THAT(readBytes(at.folder.path() / "got"), Catch::StartsWith("NRRD"));
}

TEST_CASE("A file that may not grow is an error of one line, and leaves nothing", "[tools]") {
  const BallWorkplace at;
  const std::string reference = "reference ball.vdb --tf ball.json --size 200x200 --azimuth 0 --up z --model emission ";
  const std::size_t before = filesIn(at.folder);
  const std::vector<std::string> commands{"convert ball.vdb -o a.vdb --codec none",
                                          "convert ball.vdb -o a.nvdb",
                                          "convert ball.vdb -o a.nrrd",
                                          "convert ball.vdb -o a.mhd",
                                          reference + "-o a.exr",
                                          reference + "-o a.png",
                                          "tf list -o a.png"};
  for (const std::string& command : commands) {
    CAPTURE(command);
    // Files may grow to 8 blocks of 512 or 1024 bytes; the system sends SIGXFSZ.
    const ProgramResult result = runShell(at.folder, "ulimit -f 8; $umbrick " + command);
    CHECK(result.status == 1);
    CHECK_THAT(result.err, Contains("cannot write: File too large"));
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK(filesIn(at.folder) == before);
  }
}

TEST_CASE("A transfer function of a million points is as fast as it is fine, and can be interrupted", "[tools][slow]") {
  const BallWorkplace at;
  writeRough(at.folder.path() / "rough.json", 1'000'000);
  const std::string command =
      "reference ball.vdb --tf rough.json --azimuth 0 --up z --model cone --directions 32 --tolerance 0.01 ";
  // This took several minutes before cells stopped to look at each point.
  const auto begin = std::chrono::steady_clock::now();
  CHECK(at.run(command + "--size 2x2 -o a.exr").status == 0);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  CHECK(seconds < 60);
  const Ended ended = endProgram(at.folder, command + "--size 512x512 -o b.exr", SIGTERM, after(seconds));
  CHECK(ended.seconds < 4 * kMostSeconds);  // most of it goes to the million points in the header of the picture
  CHECK(ended.result.status == 1);
  CHECK_THAT(ended.result.err, Contains("stopped; the picture holds"));
}
