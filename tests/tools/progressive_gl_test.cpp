// Runs umbrick render sample by sample and by quality, as a user would.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/gl_fixture.h"
#include "tools/ball_workplace.h"

using namespace umbrick;
using Catch::Contains;
using SceneJson = nlohmann::json;

namespace {

const std::string kRenderBall = "render ball.vdb --tf ball.json --size 24x20 --azimuth 0 --up z ";
const std::string kCone = kRenderBall + "--model cone --directions 4 ";

// Returns spacing, its unit, segments, directions, scale and method.
SceneJson sampling(const SceneJson& scene) {
  const SceneJson &s = scene.at("sampling"), &o = scene.at("occlusion");
  return {s.at("spacing"), s.at("unit"), s.at("segments"), o.at("directions"), o.at("scale"), scene.at("method")};
}

}  // namespace

TEST_CASE("Samples are averaged, and the estimate is printed and kept with the statistics", "[tools]") {
  if (!testContext()) return;
  const BallWorkplace at;
  const ProgramResult made =
      at.run(kCone + "--progressive 6 --seed 7 --layers --exr-pixel float -o a.exr --stats a.stats.json");
  INFO(made.err);
  REQUIRE(made.status == 0);
  CHECK(made.out == "a.exr\n");
  CHECK_THAT(made.err, Contains("passes 1, standard error not known yet"));
  CHECK_THAT(made.err, Contains("passes 6, standard error 0.0"));
  const ExrFile a = at.exr("a.exr");
  REQUIRE(a.layers.size() == 3);
  CHECK(*std::max_element(a.layers[0].image.pixels.begin(), a.layers[0].image.pixels.end()) > 0.2f);
  const SceneJson stats = at.json("a.stats.json"), passes = stats["progressive"];
  CHECK(passes["passes"] == 6);
  CHECK(passes["seed"] == 7);
  CHECK(passes["reached_target"] == false);
  CHECK(passes["seconds"] > 0);
  const double statistical = passes["standard_error"], systematic = passes["systematic_error"];
  CHECK(statistical > 0);
  CHECK(systematic >= 0);  // 0 where the difference may only be chance
  CHECK(passes["error"].get<double>() == Approx(std::hypot(statistical, systematic)));
  CHECK(stats["frames_ms"].size() == 6);

  // With its seed the picture can be made again from its header; another seed makes another picture.
  writeBytes(at.folder.path() / "again.json", a.metadata.at("umbrick.scene"));
  const std::string again = "render again.json --layers --exr-pixel float --progressive 6 ";
  REQUIRE(at.run(again + "--seed 7 -o b.exr").status == 0);
  REQUIRE(at.run(again + "--seed 8 -o c.exr").status == 0);
  const ExrFile b = at.exr("b.exr"), c = at.exr("c.exr");
  for (std::size_t i = 0; i < a.layers.size(); ++i) CHECK((a.layers[i].image.pixels == b.layers[i].image.pixels));
  CHECK((a.layers[0].image.pixels != c.layers[0].image.pixels));

  // Errors that are not known yet have no number in JSON.
  const ProgramResult few = at.run(kCone + "--progressive 2 -o d.exr --stats d.stats.json");
  CHECK(few.status == 0);
  CHECK(at.json("d.stats.json")["progressive"]["error"].is_null());
  // A single picture has no estimate.
  REQUIRE(at.run(kCone + "-o e.exr --stats e.stats.json").status == 0);
  CHECK_FALSE(at.json("e.stats.json").contains("progressive"));
}

TEST_CASE("A target is reached by finer slabs, or the picture is kept and the status says so", "[tools]") {
  if (!testContext()) return;
  const BallWorkplace at;
  const ProgramResult reached = at.run(kCone + "--progressive 400 --target-error 0.02 -o a.exr --stats a.stats.json");
  INFO(reached.err);
  CHECK(reached.status == 0);
  CHECK(reached.err.find("is not reached") == std::string::npos);
  const SceneJson stats = at.json("a.stats.json");
  CHECK(stats["progressive"]["reached_target"] == true);
  CHECK(stats["progressive"]["error"] <= 0.02);
  CHECK(stats["progressive"]["passes"] < 400);
  // Header and statistics name the slabs that the picture has.
  const SceneJson scene = SceneJson::parse(at.exr("a.exr").metadata.at("umbrick.scene"));
  CHECK(scene["sampling"]["spacing"] == stats["scene"]["sampling"]["spacing"]);
  CHECK(stats["spacing_world"] == stats["scene"]["sampling"]["spacing"]);

  const ProgramResult missed = at.run(kCone + "--progressive 5 --target-error 1e-6 -o b.exr --stats b.stats.json");
  CHECK(missed.status == 1);
  CHECK(missed.out == "b.exr\n");
  CHECK_THAT(missed.err, Contains("the error asked for, 1e-06, is not reached\n"));
  CHECK(at.exr("b.exr").layers[0].image.width == 24);
  CHECK(at.json("b.stats.json")["progressive"]["reached_target"] == false);

  const ProgramResult brief = at.run(kCone + "--max-seconds 1e-6 -o c.exr --stats c.stats.json");
  CHECK(brief.status == 0);
  CHECK(at.json("c.stats.json")["progressive"]["passes"] == 1);
}

TEST_CASE("Samples of a scene without directions are refused in one line and leave no file", "[tools]") {
  if (!testContext()) return;
  const BallWorkplace at;
  const std::size_t before = filesIn(at.folder);
  const auto check = [&](const std::string& arguments, int status, const std::string& message) {
    CAPTURE(arguments);
    const ProgramResult result = at.run(kRenderBall + arguments + " -o a.exr --stats s.json");
    CHECK(result.status == status);
    CHECK_THAT(result.err, Contains(message));
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK(result.out.empty());
    CHECK(filesIn(at.folder) == before);
  };
  const std::string needs =
      "need the model emission, or cone, ambient or lights and the method ordinates or light-volume";
  check("--model cone --method dos --progressive 4", 2, needs);
  check("--model cone --method dos --target-error 0.1", 2, needs);
  check("--model cone --progressive 4 --repeat 2", 2, "--repeat and --progressive exclude each other");
  check("--model cone --progressive 3 --target-error 0.1", 1, "passes is 3, a target error needs at least 4");
  check("--model cone --method dos --quality high", 2, "--quality");
  check("--model emission --quality high", 2, "--quality");
  check("--model cone --progressive 0", 2, "--progressive");
  check("--model cone --progressive -1", 2, "--progressive");
  check("--model cone --progressive 1.5", 2, "--progressive");
  check("--model cone --max-seconds 0", 2, "--max-seconds");
  check("--model cone --max-seconds -2", 2, "--max-seconds");
  check("--model cone --target-error -0.1", 2, "--target-error");
  check("--model cone --target-error nan", 1, "target error are 0.000000 and nan, must be 0 or more");
  check("--model cone --progressive 4 --seed -1", 2, "--seed");
  check("--model cone --quality best", 2, "--quality");
  // These options belong to other methods.
  for (const std::string option : {"--footprint 5", "--algorithm 2", "--passes 2", "--no-perspective-correction"})
    check("--model cone " + option, 2,
          option.substr(0, option.find(' ')) + ": is for --method dos, found light-volume");
  check("--model cone --occlusion-scale 1", 2, "--occlusion-scale: is for --method ordinates, found light-volume");
  check("--model cone --method dos --occlusion-scale 1", 2, "--occlusion-scale: is for --method ordinates, found dos");
}

TEST_CASE("A target error of light volumes is reached, or what stands in its way is said", "[tools]") {
  const BallWorkplace at;
  const auto asked = [&](const std::string& error) {
    return at.run(kRenderBall + "--model cone --backend cpu --progressive 16 --target-error " + error +
                  " -o a.exr --stats s.json");
  };
  const ProgramResult easy = asked("0.2");
  INFO(easy.err);
  CHECK(easy.status == 0);
  CHECK(at.json("s.json")["progressive"]["error"] <= 0.2);
  CHECK(at.json("s.json")["scene"]["method"] == "light-volume");
  const ProgramResult hard = asked("0.00001");
  INFO(hard.err);
  CHECK(hard.status == 1);
  CHECK_THAT(hard.err, Contains("the error asked for, 1e-05, is not reached: light is known at voxels alone"));
}

TEST_CASE("Unlit pictures are refined to a target error, by all techniques", "[tools][slow]") {
  const std::string technique = GENERATE("rays", "shear-warp", "slices");
  if (technique == "slices" && !testContext()) return;
  const BallWorkplace at;
  const auto asked = [&](const std::string& error) {
    const ProgramResult result = at.run(kRenderBall + "--model emission --spacing 2 --technique " + technique +
                                        " --target-error " + error + " -o a.exr --stats s.json");
    INFO(result.err);
    CHECK(result.status == 0);
    const SceneJson stats = at.json("s.json");
    CHECK(stats["technique"] == technique);
    CHECK(stats["progressive"]["error"] <= std::stod(error));
    return stats["scene"]["sampling"]["spacing"].get<double>();
  };
  CHECK(asked("0.5") == 2);
  CHECK(asked("0.0002") < 2);
}

TEST_CASE("A quality sets what goes together, and single options overrule it", "[tools]") {
  if (!testContext()) return;
  const BallWorkplace at;
  // Spacing is in world units in a header; here this makes no difference, since voxels are of unit size.
  const SceneJson draft{5.0, "world", 4, 6, 0.0, "ordinates"}, normal{2.5, "world", 4, 16, 0.0, "light-volume"},
      high{1.25, "world", 2, 32, 0.0, "light-volume"};
  const std::string cone = kRenderBall + "--model cone ";
  CHECK(sampling(at.sceneOf(cone + "--quality draft")) == draft);
  CHECK(sampling(at.sceneOf(cone + "--quality normal")) == normal);
  CHECK(sampling(at.sceneOf(cone + "--quality high")) == high);
  CHECK(sampling(at.sceneOf(cone)) == normal);

  const SceneJson mixed = at.sceneOf(cone + "--quality draft --directions 9 --segments 1 --occlusion-scale 0.5");
  CHECK(sampling(mixed) == SceneJson{5.0, "world", 1, 9, 0.5, "ordinates"});
  CHECK(sampling(at.sceneOf(cone + "--spacing 3 --quality high"))[0] == 3.0);
  // Segments follow the spacing.
  CHECK(sampling(at.sceneOf(cone + "--directions 9")) == SceneJson{2.5, "world", 4, 9, 0.0, "light-volume"});
  CHECK(sampling(at.sceneOf(cone + "--spacing 1")) == SceneJson{1.0, "world", 2, 16, 0.0, "light-volume"});
  CHECK(sampling(at.sceneOf(cone + "--method ordinates")) == SceneJson{2.5, "world", 4, 16, 0.0, "ordinates"});
  // A target can be refined to with ordinates alone.
  CHECK(sampling(at.sceneOf(cone + "--target-error 0.5 --progressive 4"))[5] == "ordinates");
  CHECK(sampling(at.sceneOf(cone + "--method dos"))[0] == 0.5);
  CHECK(sampling(at.sceneOf(kRenderBall + "--model emission"))[0] == 0.5);
  CHECK(sampling(at.sceneOf(kRenderBall)) == normal);  // cone is what is drawn where no model is named

  // A scene file counts as it is written, unless a quality overrules it.
  writeBytes(at.folder.path() / "scene.json",
             R"({"volume": {"file": "ball.vdb"}, "transfer": "ball.json", "camera": {"size": [24, 20]},
                 "model": "cone", "method": "ordinates", "sampling": {"spacing": 1.5},
                 "occlusion": {"directions": 7, "scale": 0.8}})");
  CHECK(sampling(at.sceneOf("render scene.json")) == SceneJson{1.5, "world", 1, 7, 0.8, "ordinates"});
  CHECK(sampling(at.sceneOf("render scene.json --quality normal")) == normal);
  CHECK(sampling(at.sceneOf("render scene.json --quality normal --directions 3"))[3] == 3);
  writeBytes(at.folder.path() / "silent.json",
             R"({"volume": {"file": "ball.vdb"}, "transfer": "ball.json", "camera": {"size": [24, 20]},
                 "model": "cone"})");
  CHECK(sampling(at.sceneOf("render silent.json"))[0] == 0.5);
}
