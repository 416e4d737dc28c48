// Runs umbrick reference as a user would.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tools/ball_workplace.h"
#include "tools/interrupt.h"
#include "umbrick/image/png.h"

using namespace umbrick;
using Catch::Contains;

namespace {

const std::string kBall = "ball.vdb --tf ball.json --azimuth 0 --up z ";
const std::string kScene = kBall + "--size 24x20 --theta 50 ";

double largest(const Image& image) {
  double most = 0;
  for (const float value : image.pixels) most = std::max<double>(most, std::abs(value));
  return most;
}

}  // namespace

TEST_CASE("The reference makes a picture with layers, statistics and the scene it can be made from again", "[tools]") {
  const BallWorkplace at;
  const ProgramResult made = at.run("reference " + kScene +
                                    "--model cone-ray --directions 32 --layers -o a.exr -o a.png --stats a.stats.json");
  REQUIRE(made.err == "");
  REQUIRE(made.status == 0);
  CHECK(made.out == "a.exr\na.png\n");
  const ExrFile file = at.exr("a.exr");
  REQUIRE(file.layers.size() == 3);
  CHECK(file.layers[0].image.width == 24);
  CHECK(file.layers[0].image.height == 20);
  CHECK(largest(file.layers[0].image) > 0.2);
  const auto stats = nlohmann::json::parse(readBytes(at.folder.path() / "a.stats.json"));
  CHECK(stats["complete"] == true);
  CHECK(stats["light_rays"].get<double>() >= 32 * stats["samples"].get<double>() * 0.9);
  CHECK(stats["scene"]["model"] == "cone-ray");
  // The header says enough to make the picture again, to the last bit.
  writeBytes(at.folder.path() / "again.json", file.metadata.at("umbrick.scene"));
  REQUIRE(at.run("reference again.json --directions 32 -o b.exr").status == 0);
  CHECK(at.exr("b.exr").layers[0].image.pixels == file.layers[0].image.pixels);
}

TEST_CASE("Monte Carlo writes its standard error as a layer and repeats by its seed on any threads", "[tools]") {
  const BallWorkplace at;
  const std::string options = "reference " + kScene + "--model ambient --integrator monte-carlo --samples 64 ";
  REQUIRE(at.run(options + "--seed 5 --threads 1 -o a.exr").status == 0);
  REQUIRE(at.run(options + "--seed 5 --threads 3 -o b.exr").err == "");
  REQUIRE(at.run(options + "--seed 6 -o c.exr").status == 0);
  const ExrFile a = at.exr("a.exr"), b = at.exr("b.exr"), c = at.exr("c.exr");
  REQUIRE(a.layers.size() == 2);
  CHECK(a.layers[1].name == "standardError");
  CHECK(a.layers[1].image.channels == 4);
  // The error is at most that of a coin tossed 64 times.
  CHECK(largest(a.layers[1].image) > 0.01);
  CHECK(largest(a.layers[1].image) <= 0.5 / std::sqrt(63.0) * 1.001);
  CHECK(a.layers[0].image.pixels == b.layers[0].image.pixels);
  CHECK(a.layers[1].image.pixels == b.layers[1].image.pixels);
  CHECK(a.layers[0].image.pixels != c.layers[0].image.pixels);
}

TEST_CASE("The reference lights a scene by its sources, which dos refuses", "[tools]") {
  const BallWorkplace at;
  writeBytes(at.folder.path() / "lit.json",
             R"({"volume": {"file": "ball.vdb"}, "transfer": "ball.json", "camera": {"size": [24, 20]},
                 "light": {"sources": [{"type": "directional", "direction": [1, 1, 1], "softAngle": 5,
                                        "radiance": [1, 0.5, 0]},
                                       {"type": "environment", "file": "sky.exr", "scale": 0.2}]}})");
  Image sky(8, 4, 3);
  for (std::size_t i = 0; i < sky.pixels.size(); i += 3) sky.pixels[i] = 1;
  writeExr(at.folder.path() / "sky.exr", {{"", sky}});
  for (const std::string integrator : {"quadrature", "monte-carlo"}) {
    const ProgramResult made =
        at.run("reference lit.json --up z --model lights --directions 8 --integrator " + integrator + " -o a.exr");
    REQUIRE(made.err == "");
    REQUIRE(made.status == 0);
    const Image image = at.exr("a.exr").layers[0].image;
    CHECK(largest(image) > 0.2);
    for (int x = 0; x < 24; ++x) CHECK(image.at(x, 10)[2] == 0);  // there is no blue light
  }
  // The header has the sources.
  writeBytes(at.folder.path() / "again.json", at.exr("a.exr").metadata.at("umbrick.scene"));
  REQUIRE(at.run("reference again.json --integrator monte-carlo -o b.exr").status == 0);
  CHECK(at.exr("b.exr").layers[0].image.pixels == at.exr("a.exr").layers[0].image.pixels);
  CHECK_THAT(at.run("reference " + kScene + "--model lights -o c.exr").err, Contains("light.sources: is empty"));
  const ProgramResult sliced = at.run("render lit.json --model lights --method dos -o c.exr");
  CHECK(sliced.status == 1);
  CHECK_THAT(sliced.err,
             Contains("method (--method): dos knows one cone around the view axis; lights need ordinates or "
                      "a light volume"));
}

TEST_CASE("A standard error is reached, or the pixels that do not reach it are counted", "[tools]") {
  const BallWorkplace at;
  const std::string options = "reference " + kScene + "--model cone --integrator monte-carlo --standard-error 0.01 ";
  const ProgramResult reached = at.run(options + "-o a.exr");
  CHECK(reached.status == 0);
  CHECK(reached.err == "");
  CHECK(largest(at.exr("a.exr").layers[1].image) <= 0.01);
  const ProgramResult limited = at.run(options + "--samples 128 -o b.exr --stats s.json");
  CHECK(limited.status == 0);
  CHECK_THAT(limited.err, Contains("pixels took all 128 samples and have a standard error above 0.01"));
  const auto stats = nlohmann::json::parse(readBytes(at.folder.path() / "s.json"));
  CHECK(stats["unconverged_pixels"].get<int>() > 10);
  CHECK(largest(at.exr("b.exr").layers[1].image) > 0.01);
}

TEST_CASE("An interrupted reference writes what is done, says so and fails", "[tools]") {
  const BallWorkplace at;
  const std::size_t before = filesIn(at.folder);
  // This would take hours.
  const std::string hours = "reference " + kBall + "--integrator monte-carlo ";
  const ProgramResult result =
      interruptProgram(at.folder, hours + "--model cone --samples 100000 --size 512x512 -o a.exr --stats s.json");
  CHECK(result.status == 1);
  CHECK_THAT(result.err, Contains("stopped; the picture holds"));
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  CHECK(at.exr("a.exr").metadata.at("umbrick.complete") == "false");
  const nlohmann::json stats = at.json("s.json");
  CHECK(stats["complete"] == false);
  CHECK(stats["share_done"].get<double>() < 1);
  CHECK(filesIn(at.folder) == before + 2);
  // The interrupt also works within a pixel.
  CHECK(interruptProgram(at.folder, hours + "--samples 1000000000 --size 2x2 -o b.exr").status == 1);
}

TEST_CASE("What the reference cannot do is refused in one line and leaves no file", "[tools]") {
  const BallWorkplace at;
  const std::size_t before = filesIn(at.folder);
  const auto complaint = [&](const std::string& arguments, int status) {
    const ProgramResult result = at.run("reference " + arguments);
    INFO(arguments << ": " << result.err);
    CHECK(result.status == status);
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK(result.out == "");
    CHECK(filesIn(at.folder) == before);
    return result.err;
  };
  CHECK_THAT(complaint("missing.vdb --tf ball.json -o a.exr", 1), Contains("missing.vdb"));
  CHECK_THAT(complaint(kScene + "--model shadows -o a.exr", 2), Contains("shadows") && Contains("ambient"));
  CHECK_THAT(complaint(kScene + "--integrator euler -o a.exr", 2), Contains("euler") && Contains("monte-carlo"));
  CHECK_THAT(complaint(kScene + "--samples 1 -o a.exr", 2), Contains("samples"));
  CHECK_THAT(complaint(kScene + "--tolerance 0 -o a.exr", 2), Contains("tolerance"));
  CHECK_THAT(complaint(kScene + "--directions 0 -o a.exr", 2), Contains("directions"));
  CHECK_THAT(complaint(kScene + "--step -1 -o a.exr", 2), Contains("step"));
  CHECK_THAT(complaint(kScene + "--step nan -o a.exr", 2), Contains("step") && Contains("nan"));
  CHECK_THAT(complaint(kScene + "--standard-error inf -o a.exr", 2), Contains("standard-error"));
  CHECK_THAT(complaint(kScene + "--seed -1 -o a.exr", 2), Contains("seed") && Contains("-1"));
  CHECK_THAT(complaint(kScene + "-o a.exr --stats ./a.exr", 2), Contains("a.exr") && Contains("overwrite"));
  CHECK_THAT(complaint(kScene + "--backend osmesa -o a.exr", 2), Contains("--backend"));
  CHECK_THAT(complaint(kScene + "-o a.tiff", 2), Contains("a.tiff") && Contains(".exr"));
  CHECK_THAT(complaint(kScene + "-o nowhere/a.exr", 1), Contains("nowhere"));
  CHECK_THAT(complaint(kBall + "--theta 90 -o a.exr", 1), Contains("theta") && Contains("90"));
}
