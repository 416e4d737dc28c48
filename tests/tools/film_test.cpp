// Films, which ffmpeg makes. Without it, what needs it is skipped.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>

#include "tools/program.h"
#include "umbrick/core/srgb.h"
#include "umbrick/image/png.h"

using namespace umbrick;
namespace fs = std::filesystem;
using Catch::Contains;

namespace {

const std::string kTurn = "render " + kSmoke + "--backend cpu --size 64x48 --background white --count 5 --orbit 90 ";

bool hasEncoder() {
  if (std::system("ffmpeg -version >/dev/null 2>&1") == 0) return true;
  std::cout << "SKIPPED: ffmpeg is not installed\n";
  return false;
}

// The pictures of a film as 8-bit RGB.
std::string decoded(const TemporaryFolder& folder, const std::string& film) {
  return runShell(folder, "ffmpeg -v error -i " + film + " -f rawvideo -pix_fmt rgb24 -").out;
}

}  // namespace

TEST_CASE("A film shows the pictures that are made beside it", "[tools]") {
  if (!hasEncoder()) return;
  const TemporaryFolder folder;
  for (const std::string film : {"film.mp4", "film.webm"}) {
    CAPTURE(film);
    const ProgramResult made = runProgram(folder, kTurn + "--overwrite --film-quality 4 -o o_%d.png -o " + film);
    INFO(made.err);
    REQUIRE(made.status == 0);
    CHECK_THAT(made.out, Contains("o_4.png\n" + film + "\n"));
    const std::string frames = decoded(folder, film);
    REQUIRE(frames.size() == 5 * 64 * 48 * 3);
    double sum = 0;
    for (int n = 0; n < 5; ++n) {
      const Image picture = readPng(folder.path() / ("o_" + std::to_string(n) + ".png"));
      for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x)
          for (int channel = 0; channel < 3; ++channel) {
            const std::size_t at = static_cast<std::size_t>(((n * 48 + 47 - y) * 64 + x) * 3 + channel);
            sum += std::abs(static_cast<unsigned char>(frames[at]) - 255 * linearToSrgb(picture.at(x, y)[channel]));
          }
    }
    // Of 255 steps: what compression at this quality and colours at half the pixels lose. Frames in another order, or
    // colours by another matrix, would differ by more.
    CHECK(sum / static_cast<double>(frames.size()) < 2);
  }
}

TEST_CASE("A film of odd edges loses a line of pixels and says so", "[tools]") {
  if (!hasEncoder()) return;
  const TemporaryFolder folder;
  const ProgramResult made =
      runProgram(folder, "render " + kSmoke + "--backend cpu --size 33x25 --count 2 -o film.mp4");
  CHECK(made.status == 0);
  CHECK_THAT(made.err, Contains("film.mp4: the film is 32 x 24 pixels"));
  CHECK(decoded(folder, "film.mp4").size() == 2 * 32 * 24 * 3);
}

TEST_CASE("Without ffmpeg a film is refused before anything is drawn", "[tools]") {
  const TemporaryFolder folder;
  const ProgramResult refused =
      runProgram(folder, kTurn + "-o o_%d.png -o film.mp4", "UMBRICK_PROGRESS=none PATH=/nonexistent");
  CHECK(refused.status == 1);
  CHECK_THAT(refused.err, Contains("umbrick: film.mp4: a film needs ffmpeg, which is not installed"));
  CHECK(filesIn(folder) == 0);
}

TEST_CASE("An encoder that fails is an error of one line and leaves no film", "[tools]") {
  const TemporaryFolder folder;
  const fs::path encoder = folder.path() / "ffmpeg";
  writeBytes(encoder, "#!/bin/sh\necho no such codec >&2\nexit 1\n");
  fs::permissions(encoder, fs::perms(0755));
  const ProgramResult failed = runProgram(folder, kTurn + "-o film.mp4", "UMBRICK_PROGRESS=none PATH=.:$PATH");
  CHECK(failed.status == 1);
  CHECK_THAT(failed.err, Contains("umbrick: film.mp4: ffmpeg: no such codec\n"));
  CHECK(filesIn(folder) == 1);
}
