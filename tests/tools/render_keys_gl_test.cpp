// Pictures of scenes whose fields have keys, and of cameras whose shutter is open for a while.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "support/gl_fixture.h"
#include "tools/frames_workplace.h"
#include "tools/refusal.h"

using namespace umbrick;
using Catch::Contains;

namespace {

const std::string kStill =
    R"("volume": {"file": "f_03.nrrd"}, "camera": {"size": [40, 30], "upAxis": "z", "frontAxis": "-y")";

// A scene of that light, with what a camera has besides, and the rest.
std::string keyed(const std::string& camera, const std::string& rest) {
  return "{" + kStill + camera + "}" + rest + "}";
}

}  // namespace

TEST_CASE("A frame of a scene with keys is the picture of a scene that has their numbers", "[tools]") {
  const FramesWorkplace at;
  at.addFrame(3);
  writeBytes(
      at.folder.path() / "s.json",
      keyed(
          R"(, "keys": [{"frame": 0, "azimuth": 10, "zoom": 1}, {"frame": 4, "azimuth": 50, "zoom": 2}], "curve": "linear")",
          R"(, "transfer": "t.json", "model": "cone", "occlusion": {"keys": [{"frame": 0, "theta": 20}, {"frame": 4, "theta": 60}], "curve": "linear"},
                      "clip": {"keys": [{"frame": 0, "planes": [[1, 0, 0, 5]]}, {"frame": 4, "planes": [[1, 0, 0, -7]]}], "curve": "linear"})"));
  const auto check = [&](const std::string& backend) {
    CAPTURE(backend);
    at.render("s.json --exr-pixel float --overwrite --count 5 -o o_%d.exr " + backend);
    for (const int n : {0, 2, 4}) {
      const auto number = [&](double first, double last) { return std::to_string(first + (last - first) * n / 4); };
      writeBytes(at.folder.path() / "one.json",
                 keyed(R"(, "azimuth": )" + number(10, 50) + R"(, "zoom": )" + number(1, 2),
                       R"(, "transfer": "t.json", "model": "cone", "occlusion": {"theta": )" + number(20, 60) +
                           R"(}, "clip": {"planes": [[1, 0, 0, )" + number(5, -7) + "]]}"));
      at.render("one.json --exr-pixel float -o one.exr " + backend);
      CAPTURE(n);
      CHECK((at.pixels("o_" + std::to_string(n) + ".exr") == at.pixels("one.exr")));
    }
    CHECK(largestDifference(at.pixels("o_0.exr"), at.pixels("o_4.exr")) > 0.1);
  };
  check("--backend cpu");
  if (testContext()) check("--backend osmesa --method ordinates");
}

TEST_CASE("A medium appears where gradients have keys, and surfaces move and fade", "[tools]") {
  const FramesWorkplace at;
  at.addFrame(3);
  writeBytes(at.folder.path() / "s.json", keyed("", R"(, "transfer": "t.json", "gradientUnit": "percent",
                          "keys": [{"frame": 0, "gradientOpacity": [0, 0]}, {"frame": 2, "gradientOpacity": [10, 50]}])"));
  at.render("s.json --backend cpu --exr-pixel float --count 3 -o o_%d.exr");
  at.render(
      "f_03.nrrd --backend cpu --model emission --tf t.json --size 40x30 --up z --front -y --azimuth 0 --elevation 0 "
      "--zoom 1 --exr-pixel float "
      "--spacing 0.5 --segments 1 --gradient-opacity 10 50 --gradient-unit percent -o one.exr");
  CHECK((at.pixels("o_2.exr") == at.pixels("one.exr")));
  CHECK(largestDifference(at.pixels("o_0.exr"), at.pixels("o_2.exr")) > 0.01);
  writeBytes(
      at.folder.path() / "i.json",
      keyed(
          "",
          R"(, "transfer": "t.json", "mode": "isosurface", "shading": {"kind": "none"}, "surfaces": [{"value": 1, "colour": [1, 1, 1]}],
                          "keys": [{"frame": 0, "surfaces": [{"value": 20, "opacity": 1}]}, {"frame": 2, "surfaces": [{"value": 90, "opacity": 0.5}]}])"));
  at.render("i.json --backend cpu --exr-pixel float --count 3 -o i_%d.exr");
  const auto shownBy = [&](const std::string& name) {
    std::size_t shown = 0;
    float most = 0;
    const std::vector<float> pixels = at.pixels(name);
    for (std::size_t i = 3; i < pixels.size(); i += 4) {
      shown += pixels[i] > 0;
      most = std::max(most, pixels[i]);
    }
    return std::pair(shown, most);
  };
  CHECK(shownBy("i_0.exr").first > shownBy("i_1.exr").first);
  CHECK(shownBy("i_1.exr").first > shownBy("i_2.exr").first);
  // A ray meets the front and the back of the ball.
  CHECK(shownBy("i_1.exr").second == Approx(1 - std::pow(1 - 0.75, 2)));
  CHECK(shownBy("i_2.exr").second == Approx(1 - std::pow(1 - 0.5, 2)));
}

TEST_CASE("Keys go with sequences: they count the numbers of files", "[tools]") {
  const FramesWorkplace at;
  for (const int n : {2, 3, 4}) at.addFrame(n);
  writeBytes(
      at.folder.path() / "s.json",
      R"({"volume": {"file": "f_%02d.nrrd"}, "camera": {"size": [40, 30], "keys": [{"frame": 2, "azimuth": 0}, {"frame": 4, "azimuth": 80}]},
                 "transfer": {"keys": [{"frame": 2, "function": "t.json"}, {"frame": 4, "function": {"points": [{"value": 1, "albedo": [1, 1, 1], "sigma_t": 0}, {"value": 1, "albedo": [1, 1, 1], "sigma_t": 9}]}}]}})");
  at.render("s.json --backend cpu -o o_%d.exr");
  CHECK(at.sceneOf("o_3.exr").at("camera").at("eye") != at.sceneOf("o_2.exr").at("camera").at("eye"));
  for (const int n : {2, 3, 4}) {
    const std::string name = "o_" + std::to_string(n) + ".exr";
    CHECK_THAT(at.sceneOf(name).at("volume").at("file").get<std::string>(), Contains("f_0" + std::to_string(n)));
    writeBytes(at.folder.path() / "again.json", at.sceneOf(name).dump());
    at.render("again.json --backend cpu -o again.exr");
    CHECK((at.pixels(name) == at.pixels("again.exr")));
  }
}

TEST_CASE("A scene with keys is said to be shown at frame 0, and options take the place of keys", "[tools]") {
  const FramesWorkplace at;
  at.addFrame(3);
  writeBytes(
      at.folder.path() / "s.json",
      keyed(R"(, "keys": [{"frame": 0, "azimuth": 10}, {"frame": 4, "azimuth": 50}])", R"(, "transfer": "t.json")"));
  CHECK_THAT(at.render("s.json --backend cpu -o one.exr").err,
             Contains("s.json: camera.azimuth as at frame 0; umbrick render --count"));
  at.render("s.json --backend cpu --count 2 -o o_%d.exr");
  CHECK((at.pixels("o_0.exr") == at.pixels("one.exr")));
  CHECK_FALSE((at.pixels("o_1.exr") == at.pixels("one.exr")));
  CHECK_THAT(at.render("s.json --backend cpu --azimuth 10 --count 2 --overwrite -o o_%d.exr").err,
             Contains("--azimuth takes the place of the keys of camera.azimuth in s.json\n"));
  CHECK((at.pixels("o_0.exr") == at.pixels("o_1.exr")));
}

TEST_CASE("What a camera sees while its shutter is open is smeared along its way, and a still one's not", "[tools]") {
  const FramesWorkplace at;
  at.addFrame(3);
  const std::string moving =
      "f_03.nrrd --backend cpu --model emission " + kSeen + "--samples 9 --overwrite --count 8 -o o_%d.exr ";
  at.render(moving + "--orbit 360 --shutter 0.000001");
  const std::vector<float> sharp = at.pixels("o_1.exr");
  at.render(moving + "--orbit 360 --shutter 1");
  const std::vector<float> smeared = at.pixels("o_1.exr");
  CHECK(largestDifference(sharp, smeared) > 0.01);
  // A turn by 45 degrees in a frame: at one thousandth of that a picture hardly differs from a still one.
  at.render(moving + "--orbit 360 --shutter 0.001");
  CHECK(largestDifference(sharp, at.pixels("o_1.exr")) < 0.02 * largestDifference(sharp, smeared));
  writeBytes(
      at.folder.path() / "s.json",
      keyed(R"(, "keys": [{"frame": 0, "azimuth": 10}, {"frame": 4, "azimuth": 10}])", R"(, "transfer": "t.json")"));
  at.render("s.json --backend cpu --exr-pixel float --samples 4 --count 2 --shutter 0.5 -o k_%d.exr");
  at.render("s.json --backend cpu --exr-pixel float --samples 4 -o still.exr");
  CHECK((at.pixels("k_1.exr") == at.pixels("still.exr")));
}

TEST_CASE("Keys and shutters that cannot be followed are refused before anything is written", "[tools]") {
  const FramesWorkplace at;
  at.addFrame(3);
  const auto refused = [&](const std::string& arguments, int status, const std::string& message) {
    expectRefusal(at.folder, "render " + arguments, status, message);
  };
  refused("f_03.nrrd --shutter 0.5 -o o.png", 2, "--shutter: expected several pictures");
  refused("f_03.nrrd --shutter 0.5 --samples 4 --count 2 -o o_%d.png", 2, "--shutter: expected a camera that moves");
  refused("f_03.nrrd --shutter 0.5 --orbit 90 --count 2 -o o_%d.png", 2, "--shutter: expected --samples of 2 or more");
  refused("f_03.nrrd --shutter 2 --orbit 90 --count 2 -o o_%d.png", 2, "0 to 1");
  // On a straight way between two keys the eye passes the point that it looks at.
  writeBytes(
      at.folder.path() / "s.json",
      R"({"volume": {"file": "f_03.nrrd"}, "transfer": "t.json", "camera": {"lookAt": [5, 5, 5], "up": [0, 0, 1], "curve": "linear",
                 "keys": [{"frame": 0, "eye": [-15, 5, 5]}, {"frame": 4, "eye": [25, 5, 5]}]}})");
  refused("s.json --backend cpu --count 5 -o o_%d.png", 1, "frame 2: camera: ");
}
