// What the program draws into a PNG, and that an EXR never has any of it.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "support/gl_fixture.h"
#include "tools/ball_workplace.h"
#include "tools/refusal.h"
#include "umbrick/image/display.h"
#include "umbrick/image/png.h"

using namespace umbrick;
using Catch::Contains;

namespace {

const std::string kLookBall = "ball.vdb --tf ball.json --azimuth 0 --up z --model emission --size 240x200 ";

// The bytes of an 8-bit display value are off by half a level, read back in linear light.
bool isClose(const Image& png, const Image& exact, double alphaLevel = 0.5 / 255 + 1e-6) {
  for (int y = 0; y < png.height; ++y)
    for (int x = 0; x < png.width; ++x) {
      if (std::abs(png.at(x, y)[3] - exact.at(x, y)[3]) > alphaLevel) return false;
      // The sRGB curve is 2.3 times as steep in linear light near 1; alpha that is rounded scales the colour.
      for (int c = 0; c < 3; ++c)
        if (std::abs(png.at(x, y)[c] - exact.at(x, y)[c]) > 2.4 * 0.5 / 255 + alphaLevel) return false;
    }
  return true;
}

}  // namespace

TEST_CASE("Options of the PNG leave the EXR as it is, to the last bit", "[tools]") {
  if (!testContext()) return;
  const BallWorkplace at;
  for (const std::string command : {"render ", "reference "}) {
    REQUIRE(at.run(command + kLookBall + "--exr-pixel float -o plain.exr -o plain.png").err == "");
    REQUIRE(at.run(command + kLookBall +
                   "--exposure 1.5 --tone filmic --background gradient --annotate triad,scale --annotate colours "
                   "--exr-pixel float -o looked.exr -o looked.png")
                .err == "");
    CHECK(readBytes(at.folder.path() / "plain.exr") == readBytes(at.folder.path() / "looked.exr"));
    CHECK(readBytes(at.folder.path() / "plain.png") != readBytes(at.folder.path() / "looked.png"));
    // Without options the PNG is the picture.
    const Image exr = at.exr("plain.exr").layers[0].image;
    CHECK(isClose(readPng(at.folder.path() / "plain.png"), displayed(exr, {})));
    // Options alone are what they say.
    REQUIRE(at.run(command + kLookBall + "--exposure 1 -o a.png").err == "");
    CHECK(isClose(readPng(at.folder.path() / "a.png"), displayed(exr, {.exposure = 1})));
    REQUIRE(at.run(command + kLookBall + "--tone-map filmic --background=gradient -o a.png").err == "");
    const Look look{.toneMap = ToneMap::filmic, .backdrop = Backdrop::gradient};
    CHECK(isClose(readPng(at.folder.path() / "a.png"), displayed(exr, look)));
    // Annotations are at the edges; the middle stays.
    REQUIRE(at.run(command + kLookBall + "--annotate all -o a.png").err == "");
    const Image annotated = readPng(at.folder.path() / "a.png"), plain = readPng(at.folder.path() / "plain.png");
    CHECK((annotated.pixels != plain.pixels));
    for (int i = 95; i < 105; ++i)
      for (int c = 0; c < 4; ++c) CHECK(annotated.at(i, i)[c] == Approx(plain.at(i, i)[c]).margin(0.01));
  }
}

TEST_CASE("A background has a name or three numbers", "[tools]") {
  if (!testContext()) return;
  const BallWorkplace at;
  const auto background = [&](const std::string& option) {
    return at.sceneOf("render --size 16x16 " + option + " ball.vdb --tf ball.json")["light"]["background"];
  };
  CHECK(background("--background white") == nlohmann::json{1, 1, 1});
  CHECK(background("--background=black") == nlohmann::json{0, 0, 0});
  CHECK(background("--background 0.5 0.25 1") == nlohmann::json{0.5, 0.25, 1});
  // A gradient replaces the background of a scene, which then is transparent in an EXR.
  writeBytes(at.folder.path() / "scene.json",
             R"({"volume": {"file": "ball.vdb"}, "transfer": "ball.json", "camera": {"size": [16, 16]},
                 "light": {"background": [1, 0, 0]}})");
  REQUIRE(at.run("render scene.json --background gradient -o a.exr -o a.png").status == 0);
  CHECK(at.exr("a.exr").layers[0].image.at(0, 0)[3] == 0);
  CHECK(readPng(at.folder.path() / "a.png").at(0, 0)[3] == 1);
}

TEST_CASE("What has no effect or no room is said", "[tools]") {
  if (!testContext()) return;
  const BallWorkplace at;
  CHECK_THAT(at.run("render " + kLookBall + "--exposure 1 -o a.exr").err,
             Contains("of a PNG only, and no PNG is asked for"));
  CHECK_THAT(at.run("render ball.vdb --tf ball.json --size 40x30 --annotate triad,scale -o a.png").err,
             Contains("a picture of 40 x 30 has no room for these annotations, which are left out: triad, scale"));
  expectRefusal(at.folder, "check ball.vdb --tf ball.json --background gradient", 2, "--background gradient");
}

TEST_CASE("Looks that make no sense are refused in one line", "[tools]") {
  if (!testContext()) return;
  const BallWorkplace at;
  for (const std::string command : {"render ", "reference "}) {
    const auto refused = [&](const std::string& options, const std::string& message) {
      expectRefusal(at.folder, command + kLookBall + options + " -o a.png", 2, message);
    };
    refused("--exposure nan", "--exposure: expected a number from -100 to 100, found nan");
    refused("--exposure 1000", "--exposure");
    refused("--tone aces", "--tone");
    refused("--background purple", "--background: expected white, black, gradient or three numbers, found 'purple'");
    refused("--background 1 0 red", "found 'red'");
    refused("--background", "--background");
    refused("--annotate north", "--annotate");
    refused("--annotate triad,north", "north");
  }
}
