// What of a scene changes over frames.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/scene/scene_keys.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>
#include <random>

#include "support/random_transfer.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/scene.h"

using namespace umbrick;
using Catch::Contains;

namespace {

constexpr double kOneDegree = std::numbers::pi / 180;

Scene keyedScene(const std::string& text) { return parseScene(text, "s.json"); }

Scene withTrack(const std::string& field, KeyCurve curve, std::vector<SceneTrack::Key> keys) {
  Scene scene;
  if (field == "camera.eye") scene.orbit.reset();
  scene.tracks = {{.field = field, .curve = curve, .keys = std::move(keys)}};
  return scene;
}

double fovAt(const Scene& scene, double frame) { return sceneAt(scene, frame).camera.fov; }

// Keys at uneven frames with any values in [0.1, 3].
std::vector<SceneTrack::Key> randomKeys(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> step(0.5, 9), value(0.1, 3);
  std::vector<SceneTrack::Key> keys;
  double frame = -4;
  for (int i = 0; i < count; ++i) keys.push_back({.frame = frame += step(random), .numbers = {value(random)}});
  return keys;
}

}  // namespace

TEST_CASE("A number has the values of its keys, and stays before the first and after the last one", "[scene]") {
  std::mt19937 random(1);
  for (const KeyCurve curve : {KeyCurve::smooth, KeyCurve::linear}) {
    const Scene scene = withTrack("camera.fov", curve, randomKeys(random, 6));
    const auto& keys = scene.tracks[0].keys;
    for (const SceneTrack::Key& key : keys) CHECK(fovAt(scene, key.frame) == key.numbers[0]);
    CHECK(fovAt(scene, keys.front().frame - 100) == keys.front().numbers[0]);
    CHECK(fovAt(scene, keys.back().frame + 0.1) == keys.back().numbers[0]);
  }
}

TEST_CASE("A linear number is the mean of two keys half way between them", "[scene]") {
  const Scene scene =
      withTrack("camera.fov", KeyCurve::linear, {{.frame = 2, .numbers = {1}}, {.frame = 6, .numbers = {2}}});
  CHECK(fovAt(scene, 3) == 1.25);
  CHECK(fovAt(scene, 4) == 1.5);
}

TEST_CASE("Two smooth keys are joined by the cubic that begins and ends at rest", "[scene]") {
  const Scene scene =
      withTrack("camera.fov", KeyCurve::smooth, {{.frame = 0, .numbers = {1}}, {.frame = 8, .numbers = {2}}});
  for (const double t : {0.125, 0.25, 0.5, 0.75})
    CHECK(fovAt(scene, 8 * t) == Approx(1 + t * t * (3 - 2 * t)).epsilon(1e-14));
}

TEST_CASE("A smooth number never leaves the range of the keys around it, and its speed does not jump", "[scene]") {
  std::mt19937 random(2);
  for (int run = 0; run < 20; ++run) {
    const Scene scene = withTrack("camera.fov", KeyCurve::smooth, randomKeys(random, 7));
    const auto& keys = scene.tracks[0].keys;
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
      const auto [low, high] = std::minmax(keys[i].numbers[0], keys[i + 1].numbers[0]);
      double last = keys[i].numbers[0];
      const bool rises = keys[i + 1].numbers[0] > last;
      for (int step = 1; step <= 50; ++step) {
        const double value = fovAt(scene, keys[i].frame + (keys[i + 1].frame - keys[i].frame) * step / 50);
        CHECK((value >= low && value <= high));
        // It runs from key to key without turning back, within rounding.
        CHECK((rises ? value >= last - 1e-14 : value <= last + 1e-14));
        last = value;
      }
    }
    // One-sided difference quotients of a smooth curve differ by its curvature times the step: at most 6 rise /
    // length^2 for a cubic piece with speeds of at most three times its slope, which is below 140 here (rise 2.9,
    // length 0.5).
    constexpr double kStep = 1e-5;
    for (const SceneTrack::Key& key : keys) {
      const double at = key.numbers[0];
      const double before = (at - fovAt(scene, key.frame - kStep)) / kStep,
                   after = (fovAt(scene, key.frame + kStep) - at) / kStep;
      CHECK(std::abs(before - after) < 200 * kStep);
    }
  }
}

TEST_CASE("A path of the eye follows a parabola through its keys, and turns with them", "[scene]") {
  const glm::dvec3 a(1, -2, 3), b(0.5, 4, -1), c(0.25, -0.125, 0.5);
  const auto parabola = [&](double t) { return a + t * b + t * t * c; };
  const glm::dmat3 turn(glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(1, 2, -1)));
  std::vector<SceneTrack::Key> keys, turned;
  for (const double frame : {0.0, 2.0, 3.0, 7.0, 8.0}) {
    const glm::dvec3 p = parabola(frame), q = turn * p;
    keys.push_back({.frame = frame, .numbers = {p.x, p.y, p.z}});
    turned.push_back({.frame = frame, .numbers = {q.x, q.y, q.z}});
  }
  const Scene path = withTrack("camera.eye", KeyCurve::smooth, keys),
              other = withTrack("camera.eye", KeyCurve::smooth, turned);
  for (double frame = 0; frame <= 8; frame += 0.25) {
    const glm::dvec3 eye = sceneAt(path, frame).camera.eye;
    CAPTURE(frame);
    // The first and the last piece begin and end at rest.
    if (frame >= 2 && frame <= 7) CHECK(glm::distance(eye, parabola(frame)) < 1e-12);
    CHECK(glm::distance(turn * eye, sceneAt(other, frame).camera.eye) < 1e-12);
  }
}

TEST_CASE("The up of a camera keeps its length between keys", "[scene]") {
  Scene scene = keyedScene(R"({"camera": {"eye": [9, 0, 0], "lookAt": [0, 0, 0],
                              "keys": [{"frame": 0, "up": [0, 0, 1]}, {"frame": 4, "up": [0, 1, 0]}], "curve": "linear"}})");
  const glm::dvec3 up = sceneAt(scene, 2).camera.up;
  CHECK(glm::distance(up, glm::dvec3(0, 1, 1) / std::numbers::sqrt2) < 1e-15);
}

TEST_CASE("Mixed functions have the mixed extinction at every value, also at steps", "[scene]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-0.5, 1.5);
  for (int run = 0; run < 20; ++run) {
    const TransferFunction a = randomTransferFunction(random, 5), b = randomTransferFunction(random, 4);
    const double share = anywhere(random) / 4 + 0.4;
    const TransferFunction mean = mixed(a, b, share);
    const double low = std::min(a.values().front(), b.values().front()),
                 high = std::max(a.values().back(), b.values().back());
    for (int i = 0; i < 100; ++i) {
      const double value = low + (high - low) * anywhere(random);
      CHECK(mean(value).sigma_t == Approx((1 - share) * a(value).sigma_t + share * b(value).sigma_t).margin(1e-12));
    }
    CHECK(mixed(a, b, 0) == a);
    CHECK(mixed(a, b, 1) == b);
  }
  const TransferFunction step({{1, {{1, 0, 0}, 0}}, {1, {{1, 0, 0}, 4}}}),
      ramp({{0, {{0, 0, 1}, 0}}, {2, {{0, 0, 1}, 2}}});
  const TransferFunction half = mixed(step, ramp, 0.5);
  CHECK(half(std::nextafter(1.0, 0.0)).sigma_t == Approx(0.5));
  CHECK(half(1).sigma_t == Approx(2.5));
  // What is transparent in one of them has the colour of the other one.
  CHECK(half(std::nextafter(1.0, 0.0)).albedo.b == Approx(1));
  CHECK(half(1).albedo.r == Approx(0.8));
}

TEST_CASE("Functions of value and gradient mix on one lattice alone", "[scene]") {
  const TransferFunction a({0, 1}, {0, 2}, std::vector<Medium>(4, {{1, 1, 1}, 1})),
      b({0, 1}, {0, 2}, std::vector<Medium>(4, {{1, 1, 1}, 3}));
  CHECK(mixed(a, b, 0.5)(0.5, 1).sigma_t == 2);
  CHECK_THROWS_WITH(mixed(a, TransferFunction({0, 1}, {0, 3}, std::vector<Medium>(4)), 0.5),
                    Contains("one lattice, found two"));
  CHECK_THROWS_WITH(mixed(a, TransferFunction(std::vector<TransferFunction::Point>{{0, {}}}), 0.5),
                    Contains("cannot be mixed"));
}

TEST_CASE("Keys of each section are read, printed and followed", "[scene]") {
  const Scene scene = keyedScene(R"({
    "camera": {"elevation": 5, "keys": [{"frame": 0, "azimuth": 10, "fov": 30}, {"frame": 10, "azimuth": 370}, {"frame": 20, "fov": 60}]},
    "transfer": {"keys": [{"frame": 0, "function": "smoke"},
                          {"frame": 10, "function": {"points": [{"value": 0, "albedo": [1, 1, 1], "sigma_t": 3}]}}]},
    "window": [0, 2],
    "mode": "isosurface", "surfaces": [{"value": 9, "colour": [1, 0, 0]}],
    "keys": [{"frame": 0, "surfaces": [{"value": 1, "opacity": 0.25}]}, {"frame": 10, "surfaces": [{"value": 2, "opacity": 0.75}]}],
    "shading": {"keys": [{"frame": 0, "specular": 0}, {"frame": 10, "specular": 1}]},
    "light": {"background": [0, 0, 0], "keys": [{"frame": 0, "background": [0, 0, 0]}, {"frame": 10, "background": [1, 1, 0]}]},
    "occlusion": {"keys": [{"frame": 0, "theta": 0}, {"frame": 10, "theta": 80}], "curve": "linear"},
    "clip": {"keys": [{"frame": 0, "box": [[0, 0, 0], [1, 1, 1]], "planes": [[1, 0, 0, 0]]},
                      {"frame": 10, "box": [[0, 0, 0], [1, 1, 3]], "planes": [[1, 0, 0, 2]]}]}})");
  const Scene half = sceneAt(scene, 5);
  CHECK(scene.orbit->azimuth == Approx(10 * kOneDegree));
  CHECK(half.orbit->azimuth == Approx(190 * kOneDegree));
  CHECK(half.orbit->elevation == Approx(5 * kOneDegree));
  CHECK(sceneAt(scene, 10).camera.fov == Approx(45 * kOneDegree));  // runs on over a key that does not name it
  REQUIRE(half.surfaces.size() == 1);
  CHECK(half.surfaces[0].value == Approx(1.5));
  CHECK(half.surfaces[0].opacity == Approx(0.5));
  CHECK(half.surfaces[0].colour == glm::dvec3(1, 0, 0));
  CHECK(half.shading.specular == Approx(0.5));
  CHECK(half.background->g == Approx(0.5));
  CHECK(sceneAt(scene, 2).occlusion.aperture == Approx(16 * kOneDegree));
  CHECK(half.clipBox->max.z == Approx(2));
  CHECK(half.clipPlanes.at(0).w == Approx(1));
  CHECK((*half.transfer)(0).sigma_t == Approx(1.5));
  CHECK(scene.transfer->valueDomain().max == 2);  // the window is of all keys
  CHECK(scene == sceneAt(scene, 0));

  const Scene again = keyedScene(printScene(scene));
  for (const double frame : {0.0, 3.3, 10.0, 15.0}) CHECK(sceneAt(again, frame) == sceneAt(scene, frame));
  CHECK(printScene(again) == printScene(scene));
}

TEST_CASE("Keys that place the eye replace the orbit, as the eye itself does", "[scene]") {
  const Scene scene = keyedScene(
      R"({"camera": {"up": [0, 0, 1], "keys": [{"frame": 3, "eye": [5, 0, 0]}, {"frame": 4, "eye": [6, 1, 0]}]}})");
  CHECK_FALSE(scene.orbit);
  CHECK(scene.camera.eye == glm::dvec3(5, 0, 0));
}

TEST_CASE("Malformed keys are refused with line, column and field", "[scene]") {
  const auto check = [](const std::string& text, const std::string& message) {
    CAPTURE(text);
    CHECK_THROWS_WITH(keyedScene(text), Contains("s.json:") && Contains(message));
  };
  check(R"({"camera": {"keys": [{"frame": 3, "fov": 20}, {"frame": 3, "fov": 30}]}})",
        "camera.keys[1].frame: expected keys in ascending order, found frame 3 after frame 3");
  check(R"({"camera": {"keys": []}})", "camera.keys: expected one key or more");
  check(R"({"camera": {"keys": [{"fov": 20}]}})", "frame");
  check(R"({"camera": {"keys": [{"frame": 0, "fow": 20}]}})", "fov");
  check(R"({"camera": {"keys": [{"frame": 0, "projection": "orthographic"}]}})",
        "camera.keys[0].projection: cannot have keys");
  check(R"({"camera": {"eye": [1, 0, 0], "keys": [{"frame": 0, "azimuth": 20}]}})",
        "camera.keys[0].azimuth: cannot have keys");
  check(R"({"camera": {"keys": [{"frame": 0, "fov": 20}, {"frame": 1, "fov": 180}]}})",
        "camera.keys[1].fov: is 180 degrees, must be in (0, 180), at frame 1");
  check(
      R"({"camera": {"eye": [1, 0, 0], "keys": [{"frame": 0, "lookAt": [0, 0, 0]}, {"frame": 1, "lookAt": [1, 0, 0]}]}})",
      "at frame 1");
  check(R"({"camera": {"curve": "linear"}})", "there are none");
  check(R"({"camera": {"keys": [{"frame": 0, "fov": 20}], "curve": "spline"}})", "camera.curve");
  check(
      R"({"clip": {"keys": [{"frame": 0, "planes": [[1, 0, 0, 0]]}, {"frame": 1, "planes": [[1, 0, 0, 0], [0, 1, 0, 0]]}]}})",
      "clip.keys[1].planes: expected as many as at frame 0");
  check(R"({"clip": {"keys": [{"frame": 0, "box": [[0, 0, 0], [0, 1, 1]]}]}})", "clip.keys[0].box");
  check(R"({"keys": [{"frame": 0, "surfaces": [{"value": 1, "colour": [1, 0, 0]}]}]})", "colour: cannot have keys");
  check(R"({"sampling": {"keys": [{"frame": 0, "spacing": 1}]}})", "sampling: unknown field");
  check(R"({"transfer": {"keys": [{"frame": 0}]}})", "function");
  check(R"({"transfer": {"keys": [{"frame": 0, "function": "smoke"}, {"frame": 1, "function":
            {"values": [0, 1], "gradients": [0, 1], "albedo": [[1,1,1],[1,1,1],[1,1,1],[1,1,1]], "sigma_t": [1, 1, 1, 1]}}]}})",
        "cannot be mixed");
}

TEST_CASE("Keys that code makes are checked, too", "[scene]") {
  const auto complaint = [](std::vector<SceneTrack> tracks) {
    Scene scene;
    scene.tracks = std::move(tracks);
    try {
      validateScene(scene);
    } catch (const InvalidArgument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(complaint({{.field = "camera.fov", .keys = {{.frame = 0, .numbers = {1}}}}}).empty());
  CHECK_THAT(complaint({{.field = "camera.fov", .keys = {}}}), Contains("camera.fov: is without a key"));
  CHECK_THAT(complaint({{.field = "camera.fov", .keys = {{.frame = 2, .numbers = {1}}, {.frame = 1, .numbers = {1}}}}}),
             Contains("ascending"));
  CHECK_THAT(complaint({{.field = "camera.fov", .keys = {{.frame = NAN, .numbers = {1}}}}}), Contains("finite"));
  CHECK_THAT(complaint({{.field = "camera.fov", .keys = {{.frame = 0}}}}), Contains("of 0 numbers"));
  CHECK_THAT(complaint({{.field = "transfer", .keys = {{.frame = 0, .numbers = {1}}}}}), Contains("function"));
  const std::vector<SceneTrack::Key> one{{.frame = 0, .numbers = {1}}};
  CHECK_THAT(complaint({{.field = "camera.fov", .keys = one}, {.field = "camera.fov", .keys = one}}),
             Contains("two lists"));
  CHECK_THAT(complaint({{.field = "camera.fov", .keys = one},
                        {.field = "camera.zoom", .curve = KeyCurve::linear, .keys = one}}),
             Contains("curve"));
  Scene scene = withTrack("camera.eye", KeyCurve::linear, {{.frame = 0, .numbers = {1, 2}}});
  CHECK_THROWS_WITH(sceneAt(scene, 0), Contains("camera.eye") && Contains("2 numbers"));
  CHECK(dropKeys(scene, "camera.eye"));
  CHECK_FALSE(dropKeys(scene, "camera.eye"));
}
