// Modes of a picture as a user asks for them.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "tools/ball_workplace.h"
#include "umbrick/image/image_difference.h"

using namespace umbrick;
using Catch::Contains;

namespace {

const std::string kModesScene = "ball.vdb --tf ball.json --size 24x20 --azimuth 20 --up z ";

const ImageLayer* layer(const ExrFile& file, std::string_view name) {
  const auto found = std::ranges::find(file.layers, name, &ImageLayer::name);
  return found == file.layers.end() ? nullptr : &*found;
}

}  // namespace

TEST_CASE("Every mode replays from the header of its picture, and is that of the reference", "[tools][modes]") {
  const BallWorkplace at;
  for (const std::string mode :
       {"mip", "minip", "average", "xray", "isosurface --iso 0.3,0.6 --iso-opacity 0.5 --layers",
        "hybrid --iso 0.3,0.6 --iso-opacity 0.5 --layers --gradient-opacity 10 40 --gradient-unit percent"}) {
    CAPTURE(mode);
    const ProgramResult made =
        at.run("render " + kModesScene + "--spacing 0.25 --exr-pixel float --mode " + mode + " -o a.exr -o a.png");
    INFO(made.err);
    REQUIRE(made.status == 0);
    const ExrFile file = at.exr("a.exr");
    REQUIRE(layer(file, "value"));
    CHECK((layer(file, "normal") != nullptr) == (mode[0] == 'i' || mode[0] == 'h'));
    writeBytes(at.folder.path() / "again.json", file.metadata.at("umbrick.scene"));
    REQUIRE(at.run("render again.json --exr-pixel float --layers -o b.exr").status == 0);
    CHECK(at.exr("b.exr").layers[0].image.pixels == file.layers[0].image.pixels);
    REQUIRE(at.run("reference again.json -o r.exr --layers").status == 0);
    const ExrFile exact = at.exr("r.exr");
    // Whether a pixel at the rim is drawn depends on whether a sample meets anything there: its colour is dark.
    CHECK(differenceOf(file.layers[0].image, exact.layers[0].image).rmseRgb < 5e-3);
    CHECK(differenceOf(layer(file, "value")->image, layer(exact, "value")->image).rmse < 2e-3);
    CHECK(at.run("compare a.exr r.exr").status == 0);
  }
}

TEST_CASE("A level set is drawn where it is 0, and the value may be given", "[tools][modes]") {
  const BallWorkplace at;
  const openvdb::FloatGrid::Ptr grid = makeSphereLevelSet(8).grid->deepCopy();
  grid->setName("surface");
  writeGrids(at.folder.path() / "set.vdb", {grid});
  const ProgramResult made = at.run("render set.vdb --size 32x32 --mode isosurface -o a.exr");
  CHECK(made.status == 0);
  CHECK_THAT(made.err, Contains("--iso 0"));
  const auto scene = nlohmann::json::parse(at.exr("a.exr").metadata.at("umbrick.scene"));
  CHECK(scene["surfaces"][0]["value"] == 0);
  CHECK(at.run("render set.vdb --size 32x32 --mode isosurface --iso 1 -o b.exr").status == 0);
  CHECK(at.exr("b.exr").layers[0].image.pixels != at.exr("a.exr").layers[0].image.pixels);
}

TEST_CASE("What a mode cannot do is said in one line", "[tools][modes]") {
  const BallWorkplace at;
  const auto refused = [&](const std::string& arguments) {
    const ProgramResult result = at.run("render " + kModesScene + arguments + " -o a.png");
    CHECK(result.status != 0);
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    return result.err;
  };
  CHECK_THAT(refused("--mode isosurface"),
             Contains("--mode isosurface: needs --iso with the value of the surface, between "));
  CHECK_THAT(refused("--mode isosurface --iso 7"), Contains("7 has no surface, the volume has values from 0 to 1"));
  CHECK_THAT(refused("--iso 0.5"), Contains("are for --mode isosurface and hybrid, found integrate"));
  CHECK_THAT(refused("--mode isosurface --iso 0.5 --iso-opacity 0.5,0.5"), Contains("--iso-opacity: expected 1"));
  CHECK_THAT(refused("--mode isosurface --iso 0.5 --iso-opacity 2"), Contains("surfaces[0].opacity: is 2"));
  CHECK_THAT(refused("--mode isosurface --iso 0.5 --shading-light sources"), Contains("no directional source"));
  CHECK_THAT(refused("--mode hybrid"), Contains("--mode hybrid: needs --iso with the value of the surface, between "));
  CHECK_THAT(refused("--mode hybrid --iso 0.5 --technique slices"),
             Contains("hybrid is not rendered by the technique slices but by rays"));
  CHECK_THAT(refused("--gradient-opacity 2 1"),
             Contains("--gradient-opacity: is (2 1), must be two numbers that ascend"));
  CHECK_THAT(refused("--gradient-opacity -2 1"),
             Contains("--gradient-opacity: is (-2 1), must be two finite numbers of 0 or more"));
  CHECK_THAT(refused("--mode mip --technique shear-warp"),
             Contains("mip is not rendered by the technique shear-warp but by rays"));
  CHECK_THAT(refused("--mode mip --technique slices"),
             Contains("mip is not rendered by the technique slices but by rays"));
  CHECK_THAT(refused("--mode average --shading phong"), Contains("the mode average reflects no light"));
  const ProgramResult lit = at.run("render " + kModesScene + "--mode mip --model cone --layers -o a.exr");
  CHECK(lit.status == 0);
  CHECK_THAT(at.run("render " + kModesScene + "--mode mip --gradient-opacity 1 2 -o a.exr").err,
             Contains("--gradient-opacity has no effect on the mode mip, which shows no medium"));
  CHECK_THAT(lit.err, Contains("--model has no effect on the mode mip"));
  CHECK_THAT(lit.err, Contains("has neither V nor Z"));
}
