// The program averages pixels over their area and says so.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "support/gl_fixture.h"
#include "support/observed_order.h"
#include "tools/ball_workplace.h"
#include "tools/refusal.h"

using namespace umbrick;
using Catch::Contains;

namespace {
const std::string kSampledBall =
    "ball.vdb --tf ball.json --model emission --azimuth 0 --up z --size 24x20 --spacing 0.1 --spacing-unit world ";
}

TEST_CASE("Renderer and reference average over the same places, and their files say so", "[tools]") {
  if (!testContext()) return;
  const BallWorkplace at;
  REQUIRE(at.run("render " + kSampledBall + "--samples 6 --layers --exr-pixel float -o a.exr --stats a.json").err ==
          "");
  REQUIRE(at.run("reference " + kSampledBall + "--pixel-samples 6 --layers -o b.exr --stats b.json").err == "");
  REQUIRE(at.run("render " + kSampledBall + "--layers --exr-pixel float -o c.exr").err == "");
  const ExrFile a = at.exr("a.exr"), b = at.exr("b.exr"), c = at.exr("c.exr");
  CHECK(a.metadata.at("umbrick.filter") == "box, 6 samples a pixel");
  CHECK(b.metadata.at("umbrick.filter") == "box, 6 samples a pixel");
  CHECK(c.metadata.at("umbrick.filter") == "point, the centre of each pixel");
  for (const char* name : {"a.json", "b.json"}) CHECK(at.json(name)["scene"]["sampling"]["pixelSamples"] == 6);
  const double same = rmsDifference(a.layers[0].image, b.layers[0].image);
  const double other = rmsDifference(c.layers[0].image, b.layers[0].image);
  INFO("with the same samples " << same << ", with one " << other);
  CHECK(same < 2e-3);
  CHECK(other > 5 * same);

  // The scene in the header makes the picture again, and one sample is what there was without the option.
  writeBytes(at.folder.path() / "again.json", a.metadata.at("umbrick.scene"));
  REQUIRE(at.run("render again.json --layers --exr-pixel float -o again.exr").status == 0);
  REQUIRE(at.run("render again.json --samples 1 --layers --exr-pixel float -o one.exr").status == 0);
  const ExrFile again = at.exr("again.exr"), one = at.exr("one.exr");
  for (std::size_t i = 0; i < a.layers.size(); ++i) {
    CHECK((again.layers[i].image.pixels == a.layers[i].image.pixels));
    CHECK((one.layers[i].image.pixels == c.layers[i].image.pixels));
  }
}

TEST_CASE("The passes of a progressive picture are its samples of the pixels' area", "[tools]") {
  if (!testContext()) return;
  const BallWorkplace at;
  const std::string cone =
      "render ball.vdb --tf ball.json --azimuth 0 --up z --size 24x20 --model cone --directions 2 --spacing 1 "
      "--progressive 5 ";
  REQUIRE(at.run(cone + "-o a.exr --stats a.json").status == 0);
  CHECK(at.exr("a.exr").metadata.at("umbrick.filter") == "box, 5 samples a pixel");
  CHECK(at.json("a.json")["scene"]["sampling"]["pixelSamples"] == 5);
  // Through the centres of pixels, on request.
  REQUIRE(at.run(cone + "--samples 1 -o b.exr").status == 0);
  CHECK(at.exr("b.exr").metadata.at("umbrick.filter") == "point, the centre of each pixel");
  CHECK((at.exr("a.exr").layers[0].image.pixels != at.exr("b.exr").layers[0].image.pixels));
  const ProgramResult told = at.run(cone + "--samples 3 -o c.exr");
  CHECK(told.status == 0);
  CHECK_THAT(told.err, Contains("--samples 3 has no effect"));
  CHECK((at.exr("a.exr").layers[0].image.pixels == at.exr("c.exr").layers[0].image.pixels));
}

TEST_CASE("Numbers of samples that make no sense are refused in one line", "[tools]") {
  if (!testContext()) return;
  const BallWorkplace at;
  for (const std::string number : {"0", "-1", "4097"})
    expectRefusal(at.folder, "render " + kSampledBall + "--samples " + number + " -o a.exr", 1, "--samples");
  expectRefusal(at.folder, "render " + kSampledBall + "--samples 1.5 -o a.exr", 2, "--samples");
  expectRefusal(at.folder, "render " + kSampledBall + "--samples many -o a.exr", 2, "--samples");
  expectRefusal(at.folder, "reference " + kSampledBall + "--pixel-samples 0 -o a.exr", 1, "--pixel-samples");
  expectRefusal(at.folder,
                "reference " + kSampledBall + "--integrator monte-carlo --pixel-samples 8 --samples 15 -o a.exr", 1,
                "samples is 15, must be at least 16, two for each sample of a pixel");
}

TEST_CASE("A check holds for averaged pictures, too", "[tools][slow]") {
  if (!testContext()) return;
  const BallWorkplace at;
  const ProgramResult result = at.run("check ball.vdb --tf ball.json --size 48x40 --samples 3 --json");
  INFO(result.err << result.out);
  CHECK(result.status == 0);
  CHECK(nlohmann::json::parse(result.out)["scene"]["sampling"]["pixelSamples"] == 3);
}
