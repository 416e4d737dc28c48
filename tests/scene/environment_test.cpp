// Tests environment maps as lists and samples of directions.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>

#include "scene/lights_scene.h"
#include "support/closed_forms.h"
#include "support/complaint.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/image/exr.h"
#include "umbrick/scene/lights.h"

using namespace umbrick;
using Catch::Contains;

namespace {

using Sky = std::function<glm::dvec3(double u, double v)>;  // u from the left and v from the bottom, in [0, 1]

LightSource environment(int width, int height, const Sky& sky, LightFrame frame = LightFrame::view) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<float>(sky((x + 0.5) / width, (y + 0.5) / height)[c]);
  EnvironmentLight light;
  light.file = "sky.exr";
  light.image = std::make_shared<const Image>(std::move(image));
  return {frame, light};
}

// Returns a map with one bright pixel, counted from the left and from the bottom; the rest is black.
LightSource onePixel(int width, int height, int atX, int atY, const glm::dvec3& radiance) {
  return environment(width, height, [=](double u, double v) {
    return static_cast<int>(u * width) == atX && static_cast<int>(v * height) == atY ? radiance : glm::dvec3(0);
  });
}

EnvironmentLight& mapOf(LightSource& source) { return std::get<EnvironmentLight>(source.light); }

// Returns a smooth and coloured map with a bright spot.
glm::dvec3 varied(double u, double v) {
  const double spot = 40 * std::exp(-300 * ((u - 0.6) * (u - 0.6) + (v - 0.7) * (v - 0.7)));
  return {1 + 0.8 * std::sin(6 * u) + spot, 0.5 + 0.4 * std::cos(9 * v) + 0.8 * spot, v + 0.3 * spot};
}

// Returns the sum of f over the part of a map that is in front. Each pixel is cut into parts, and the code under test
// is not used. A pixel's edge towards the plane is off by a part of it at most.
glm::dvec3 bruteForce(const ResolvedScene& scene, const std::function<double(const glm::dvec3&)>& f, int parts) {
  const auto& light = std::get<EnvironmentLight>(scene.lights[0].light);
  const CameraFrame frame = cameraFrame(scene.camera);
  const auto toWorld = [&](const glm::dvec3& v) {
    return scene.lights[0].frame == LightFrame::world ? v : v.x * frame.right + v.y * frame.up - v.z * frame.forward;
  };
  const glm::dvec3 up = glm::normalize(toWorld(light.up)), right = glm::normalize(glm::cross(toWorld(light.front), up));
  const glm::dvec3 front = glm::cross(up, right);
  const int width = light.image->width * parts, height = light.image->height * parts;
  glm::dvec3 sum(0);
  for (int y = 0; y < height; ++y) {
    const double s0 = std::sin(std::numbers::pi * (double(y) / height - 0.5)),
                 s1 = std::sin(std::numbers::pi * (double(y + 1) / height - 0.5));
    const double s = 0.5 * (s0 + s1), c = std::sqrt(1 - s * s);
    for (int x = 0; x < width; ++x) {
      const double longitude = 2 * std::numbers::pi * ((x + 0.5) / width - 0.5);
      const glm::dvec3 w = c * std::cos(longitude) * front + c * std::sin(longitude) * right + s * up;
      if (glm::dot(w, -frame.forward) <= 0) continue;
      const float* pixel = light.image->at(x / parts, y / parts);
      sum += glm::dvec3(pixel[0], pixel[1], pixel[2]) * ((s1 - s0) * 2 * std::numbers::pi / width * f(w));
    }
  }
  return sum * light.scale / (4 * std::numbers::pi);
}

double relative(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) / glm::length(b); }

}  // namespace

TEST_CASE("A map is seen from its centre: up, front and to the right of it", "[scene]") {
  // Small pixels of a map of 64 x 32 lie around places that are known; in the view the middle is towards the viewer.
  const auto towards = [](const LightSource& source) {
    const ResolvedScene scene = sceneWith({source});
    const auto list = lightDirections(scene, 1);
    REQUIRE(list.size() == 1);
    const CameraFrame frame = cameraFrame(scene.camera);
    const glm::dvec3 w = list[0].direction;
    return glm::dvec3(glm::dot(w, frame.right), glm::dot(w, frame.up), -glm::dot(w, frame.forward));
  };
  const auto at = [](double longitude, double latitude) {
    return glm::dvec3(-std::sin(longitude) * std::cos(latitude), std::sin(latitude),
                      std::cos(longitude) * std::cos(latitude));
  };
  // Pixels are 0.1 rad wide. The centre of power of a pixel is nearer to the equator than its centre, by about a
  // twelfth of the squared width times the tangent of the latitude, which is up to 3.
  const double step = std::numbers::pi / 32;
  CHECK(glm::length(towards(onePixel(64, 32, 32, 16, glm::dvec3(1))) - at(0.5 * step, 0.5 * step)) < 3e-3);
  CHECK(glm::length(towards(onePixel(64, 32, 40, 16, glm::dvec3(1))) - at(8.5 * step, 0.5 * step)) < 3e-3);
  CHECK(glm::length(towards(onePixel(64, 32, 30, 28, glm::dvec3(1))) - at(-1.5 * step, 12.5 * step)) < 3e-3);
  // With the front to the viewer's right the column a quarter right of the middle is in front of the viewer.
  LightSource turned = onePixel(64, 32, 48, 16, glm::dvec3(1));
  mapOf(turned).front = {5, 3, 0};  // only the part perpendicular to up counts
  CHECK(glm::length(towards(turned) - at(0.5 * step, 0.5 * step)) < 3e-3);
  LightSource upsideDown = onePixel(64, 32, 32, 28, glm::dvec3(1));
  mapOf(upsideDown).up = {0, -2, 0};
  CHECK(towards(upsideDown).y < -0.9);
}

TEST_CASE("By default the frames view and world agree at azimuth 0 and elevation 0", "[scene]") {
  const TemporaryFolder folder;
  Image image(16, 8, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i % 7);
  writeExr(folder.path() / "sky.exr", {{"", image}});
  const auto parse = [&](const std::string& frame) {
    Scene scene = parseScene(
        R"({"model": "lights", "light": {"sources": [{"type": "environment", "file": "sky.exr", "frame": ")" + frame +
            "\"}]}}",
        "s.json", folder.path());
    scene.transfer = loadTransferFunction("smoke");
    return lightDirections(resolveScene(scene, {glm::dvec3(-1), glm::dvec3(1)}, glm::dmat4(1)), 30);
  };
  const auto view = parse("view"), world = parse("world");
  REQUIRE(view.size() == world.size());
  for (std::size_t i = 0; i < view.size(); ++i) {
    CHECK(glm::length(view[i].direction - world[i].direction) < 1e-12);
    CHECK(glm::length(view[i].radiance - world[i].radiance) < 1e-12);
  }
}

TEST_CASE("The front half of a constant map is the hemisphere, however it is turned", "[scene]") {
  for (const glm::dvec3& up :
       {glm::dvec3(0, 1, 0), glm::dvec3(1, 2, 3), glm::dvec3(0, 0, 1), glm::dvec3(1, 0, -1e-9)}) {
    LightSource source = environment(5, 3, [](double, double) { return glm::dvec3(2, 1, 0.5); });
    mapOf(source).up = up;
    mapOf(source).front = {0.3, 0.2, 0.9};
    mapOf(source).scale = 3;
    const ResolvedScene scene = sceneWith({source});
    const glm::dvec3 n = towardsViewer(scene);
    // The sum is half of the sphere, by the midpoints of strips that the viewer's plane cuts.
    CHECK(relative(total(lightDirections(scene, 2000)), 1.5 * glm::dvec3(2, 1, 0.5)) < 2e-4);
    for (const auto& list : {lightDirections(scene, 2000), lightSamples(scene, 0, 2000, 1)}) {
      // Of 2000 samples those in a strip that the plane touches weigh more or less.
      CHECK(relative(total(list), 1.5 * glm::dvec3(2, 1, 0.5)) < 2e-3);
      // The mean cosine over the hemisphere is 1/2, and E2(1) of it passes a slab of unit depth; each of 2000 parts is
      // a 45th of the hemisphere across.
      CHECK(relative(applied(list, [&](const glm::dvec3& w) { return glm::dot(w, n); }), 0.75 * glm::dvec3(2, 1, 0.5)) <
            2e-3);
      const double exact = integral(0, 1, [](double c) { return c > 0 ? std::exp(-1 / c) : 0; });
      CHECK(relative(applied(list, [&](const glm::dvec3& w) { return std::exp(-1 / glm::dot(w, n)); }),
                     1.5 * exact * glm::dvec3(2, 1, 0.5)) < 5e-3);
      for (const LightDirection& light : list) {
        CHECK(glm::dot(light.direction, n) > 0);
        CHECK(glm::length(light.direction) == Approx(1).epsilon(1e-14));
      }
    }
  }
}

TEST_CASE("A constant map is the whole sphere where light may come from behind", "[scene]") {
  for (const glm::dvec3& up : {glm::dvec3(0, 1, 0), glm::dvec3(1, 2, 3)}) {
    LightSource source = environment(5, 3, [](double, double) { return glm::dvec3(2, 1, 0.5); });
    mapOf(source).up = up;
    mapOf(source).scale = 3;
    ResolvedScene scene = sceneWith({source});
    scene.method = Method::lightVolume;
    for (const auto& list :
         {lightDirections(scene, 1000), lightDirections(scene, 1000, 0.4), lightSamples(scene, 0, 2000, 1)}) {
      CHECK(relative(total(list), 3.0 * glm::dvec3(2, 1, 0.5)) < 1e-3);
      // No direction is preferred: the mean cosine is 0, and the mean of its square 1/3, along any axis. Of 1000 parts
      // each is a 16th of a radian across.
      for (const glm::dvec3& axis : {towardsViewer(scene), glm::dvec3(1, 0, 0), glm::dvec3(0.6, 0, 0.8)}) {
        CHECK(std::abs(applied(list, [&](const glm::dvec3& w) { return glm::dot(w, axis); }).r) < 6 * 5e-3);
        CHECK(applied(list, [&](const glm::dvec3& w) { return glm::dot(w, axis) * glm::dot(w, axis); }).r ==
              Approx(6.0 / 3).epsilon(1e-2));
      }
    }
  }
}

TEST_CASE("One direction of a light from all sides is one", "[scene]") {
  ResolvedScene scene = sceneWith({environment(8, 4, [](double, double) { return glm::dvec3(1); })});
  scene.method = Method::lightVolume;
  const std::vector<LightDirection> list = lightDirections(scene, 1);
  REQUIRE(list.size() == 1);
  CHECK(glm::length(list.front().direction) == Approx(1));
  CHECK(list.front().radiance.r == Approx(1).epsilon(1e-3));
}

TEST_CASE("A light behind what is seen keeps its place and its power in a whole map", "[scene]") {
  // One bright pixel in the middle of the map, which is behind the viewer, and a brighter one a half turn from it.
  LightSource source = environment(64, 32, [](double x, double y) {
    const bool middle = std::abs(y - 0.5) < 0.02;
    return glm::dvec3(middle && std::abs(x - 0.5) < 0.01 ? 1 : middle && x < 0.02 ? 3 : 0);
  });
  ResolvedScene scene = sceneWith({source});
  const auto powerBehind = [&](const std::vector<LightDirection>& list) {
    return applied(list, [&](const glm::dvec3& w) { return glm::dot(w, towardsViewer(scene)) < -0.9 ? 1.0 : 0.0; }).r;
  };
  CHECK(powerBehind(lightDirections(scene, 64)) == 0);
  scene.method = Method::lightVolume;
  const std::vector<LightDirection> list = lightDirections(scene, 64);
  CHECK(powerBehind(list) > 0.55 * total(list).r);
}

// The sum over parts is the same for any number of them, and it is that of the map.
TEST_CASE("The median cut keeps all of the light", "[scene]") {
  LightSource source = environment(96, 48, varied, LightFrame::world);
  mapOf(source).up = {0.2, 0.9, -0.4};
  const ResolvedScene scene = sceneWith({source});
  const glm::dvec3 exact = bruteForce(
      scene, [](const glm::dvec3&) { return 1.0; }, 16);
  const glm::dvec3 one = total(lightDirections(scene, 1));
  CHECK(relative(one, exact) < 5e-4);  // the map has 768 rows, as above
  for (const int count : {2, 3, 16, 17, 100, 1000})
    for (const double rotation : {0.0, 0.7, 4.0}) {
      const auto list = lightDirections(scene, count, rotation);
      CHECK(relative(total(list), one) < 1e-13);
      // A cell of the spot may hold several of a thousand shares.
      CHECK(static_cast<int>(list.size()) <= count);
      CHECK(static_cast<int>(list.size()) >= (count > 100 ? count * 99 / 100 : count));
      // Parts have equal power, up to the cells that they consist of; the spot's cells have a few thousandths
      // of all power.
      if (count > 100) continue;
      const double share = (one.r + one.g + one.b) / count;
      for (const LightDirection& light : list)
        CHECK(light.radiance.r + light.radiance.g + light.radiance.b == Approx(share).epsilon(0.01 + 0.005 * count));
    }
}

TEST_CASE("The median cut converges, and its rotations average to a better one", "[scene][slow]") {
  LightSource source = environment(96, 48, varied, LightFrame::world);
  const ResolvedScene scene = sceneWith({source});
  const glm::dvec3 axis = towardsViewer(scene);
  const auto f = [&](const glm::dvec3& w) { return std::exp(-1 / std::max(1e-9, glm::dot(w, axis))); };
  const glm::dvec3 exact = bruteForce(scene, f, 8);
  // The error is of second order in the width of parts where they are as long as they are wide, which parts at the edge
  // of the bright spot are not. The mean over rotations is compared, since single sets are off by more or by less: four
  // times as many directions never have a larger error, and 256 times as many less than a hundredth of it.
  std::vector<double> errors;
  for (const int count : {4, 16, 64, 256, 1024}) {
    double error = 0;
    for (int i = 0; i < 16; ++i)
      error += relative(applied(lightDirections(scene, count, 2 * std::numbers::pi * i / 16), f), exact) / 16;
    INFO(count << " directions: " << error);
    if (!errors.empty()) CHECK(error < errors.back());
    errors.push_back(error);
  }
  CHECK(errors.back() < 0.01 * errors.front());
  double single = 0;
  glm::dvec3 mean(0);
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 set = applied(lightDirections(scene, 8, 2 * std::numbers::pi * i / 8), f);
    single += relative(set, exact) / 8;
    mean += set / 8.0;
  }
  CHECK(relative(mean, exact) < single);
}

TEST_CASE("Samples of a map have its mean over seeds, and converge faster than random ones", "[scene][slow]") {
  LightSource source = environment(32, 16, varied, LightFrame::world);
  mapOf(source).up = {0.2, 0.9, -0.4};
  const ResolvedScene scene = sceneWith({source});
  // The function is not symmetric around the view, and large at its edge, where pixels are cut.
  const glm::dvec3 axis = glm::normalize(towardsViewer(scene) + glm::dvec3(0.5, -0.3, 0.4));
  const auto f = [&](const glm::dvec3& w) { return 1 + glm::dot(w, axis) * glm::dot(w, axis); };
  const glm::dvec3 exact = bruteForce(scene, f, 32);
  for (const int count : {1, 5}) {
    glm::dvec3 sum(0), squares(0);
    const int seeds = 4000;
    for (int seed = 0; seed < seeds / count; ++seed) {
      const auto list = lightSamples(scene, 3, count, static_cast<std::uint64_t>(seed));
      CHECK(list.size() == static_cast<std::size_t>(count));
      const glm::dvec3 x = applied(list, f);
      sum += x;
      squares += x * x;
    }
    const double n = seeds / count;
    for (int c = 0; c < 3; ++c) {
      const double mean = sum[c] / n, error = std::sqrt((squares[c] / n - mean * mean) / n);
      // Allowed are four standard errors, and the error of the sum over 512 x 512 parts of the map along the plane.
      CHECK(std::abs(mean - exact[c]) < 4 * error + 1e-3 * exact[c]);
    }
  }
  // The samples are compared with their own limit, 2^15 of them, so that no other error matters.
  const glm::dvec3 limit = applied(lightSamples(scene, 0, 1 << 15, 99), f);
  CHECK(relative(limit, exact) < 2e-3);
  const auto error = [&](int count) {
    double squares2 = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const double off = relative(applied(lightSamples(scene, 0, count, seed), f), limit);
      squares2 += off * off;
    }
    return std::sqrt(squares2 / 8);
  };
  const double order = std::log2(error(16) / error(1024)) / 6;
  INFO("order " << order);
  CHECK(order > 0.65);  // the order of random samples is 0.5
}

// A sun of one pixel is a sharp light of its radiance times its solid angle / (4 pi), in lists and in samples.
TEST_CASE("A single bright pixel is one direction in lists and stays inside itself in samples", "[scene]") {
  const ResolvedScene scene = sceneWith({onePixel(720, 360, 400, 250, {8e4, 7e4, 5e4})});
  const double s0 = std::sin(std::numbers::pi * (250 / 360.0 - 0.5)),
               s1 = std::sin(std::numbers::pi * (251 / 360.0 - 0.5));
  const glm::dvec3 expected =
      glm::dvec3(8e4, 7e4, 5e4) * ((s1 - s0) * 2 * std::numbers::pi / 720 / (4 * std::numbers::pi));
  const auto list = lightDirections(scene, 64);
  CHECK(list.size() <= 2);  // a pixel may lie in two cells
  CHECK(relative(total(list), expected) < 1e-6);
  for (const LightDirection& light : lightSamples(scene, 0, 64, 1)) {
    CHECK(glm::dot(light.direction, list[0].direction) > std::cos(1.5 * std::numbers::pi / 360));
    CHECK(relative(64.0 * light.radiance, expected) < 1e-6);
  }
}

TEST_CASE("A map that is dark in front lights nothing", "[scene]") {
  const ResolvedScene scene = sceneWith({onePixel(8, 4, 0, 2, glm::dvec3(1))});
  for (const auto& list : {lightDirections(scene, 16), lightSamples(scene, 0, 16, 1)}) {
    REQUIRE(list.size() == 1);
    CHECK(total(list) == glm::dvec3(0));
    CHECK(glm::dot(list[0].direction, towardsViewer(scene)) > 0.999);
  }
}

TEST_CASE("An environment comes back from its JSON with its file's name and pixels", "[scene]") {
  const TemporaryFolder folder;
  Image image(6, 3, 4);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = 0.37f * static_cast<float>(i);
  writeExr(folder.path() / "sky.exr", {{"", image}}, {ExrPixel::float32, {}});
  writeBytes(folder.path() / "s.json", R"({"light": {"sources": [{"type": "environment", "file": "sky.exr",
      "up": [0.1, 1, 0.3], "front": [1, 0, 1], "scale": 0.3, "frame": "world"}]}})");
  const Scene scene = readScene(folder.path() / "s.json");
  const auto& light = std::get<EnvironmentLight>(scene.lights.at(0).light);
  CHECK(light.file == folder.path() / "sky.exr");
  CHECK(light.image->pixels == image.pixels);
  CHECK(light.up == glm::dvec3(0.1, 1, 0.3));
  CHECK(light.front == glm::dvec3(1, 0, 1));
  CHECK(light.scale == 0.3);
  CHECK(parseScene(printScene(scene), "again") == scene);
  Scene other = scene;
  CHECK(other == scene);
  mapOf(other.lights[0]).image = std::make_shared<const Image>(6, 3, 4);
  CHECK_FALSE(other == scene);
  mapOf(other.lights[0]).file.clear();
  CHECK_THAT(complaint<InvalidArgument>([&] { printScene(other); }), Contains("no file"));
}

TEST_CASE("Maps that cannot be used are refused with what is wrong", "[scene]") {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& name, const std::vector<ImageLayer>& layers) {
    writeExr(folder.path() / name, layers);
  };
  Image good(4, 2, 3), negative = good, endless = good;
  negative.at(1, 0)[2] = -1;
  endless.at(2, 1)[0] = std::numeric_limits<float>::infinity();
  write("good.exr", {{"", good}});
  write("negative.exr", {{"", negative}});
  write("endless.exr", {{"", endless}});
  write("depth.exr", {{"Z", Image(4, 2, 1)}});
  writeBytes(folder.path() / "text.exr", "not an image");
  const auto refused = [&](const std::string& fields) {
    return complaint<IoError>([&] {
      parseScene("{\"light\": {\"sources\": [{\"type\": \"environment\", " + fields + "}]}}", "s.json", folder.path());
    });
  };
  CHECK_THAT(refused(R"("scale": 1)"), Contains("light.sources[0]: the field 'file' is missing"));
  CHECK_THAT(refused(R"("file": "none.exr")"),
             Contains("light.sources[0].file: ") && Contains("none.exr: cannot read"));
  CHECK_THAT(refused(R"("file": "text.exr")"), Contains("text.exr: not an EXR file"));
  CHECK_THAT(refused(R"("file": "depth.exr")"), Contains("depth.exr: has no channels R, G, B and no Y"));
  CHECK_THAT(refused(R"("file": "negative.exr")"),
             Contains("negative.exr: pixel 1, 1 from the top left is [0.000000, 0.000000, -1.000000], must be finite"));
  CHECK_THAT(refused(R"("file": "endless.exr")"), Contains("endless.exr: pixel 2, 0 from the top left is [inf, "));
  CHECK_THAT(refused(R"("file": "good.exr", "up": [0, 0, 0])"), Contains("light.sources[0].up: is [0, 0, 0], must be"));
  CHECK_THAT(refused(R"("file": "good.exr", "up": [1, 0, 0], "front": [-2, 0, 0])"),
             Contains("light.sources[0].front: is [-2, 0, 0], must be across up, which is [1, 0, 0]"));
  CHECK_THAT(refused(R"("file": "good.exr", "scale": -1)"),
             Contains("light.sources[0].scale: is -1, must be 0 or more"));
  CHECK_THAT(refused(R"("file": "good.exr", "theta": 1)"), Contains("light.sources[0]: unknown field; known are"));
  // The same light is refused when it is made in code.
  ResolvedScene scene = sceneWith({LightSource{LightFrame::view, EnvironmentLight{}}});
  CHECK_THAT(complaint<InvalidArgument>([&] { validateScene(scene); }),
             Contains("light.sources[0].file: is not loaded"));
  LightSource source{LightFrame::view, EnvironmentLight{}};
  mapOf(source).image = std::make_shared<const Image>(negative);
  CHECK_THAT(complaint<InvalidArgument>([&] { lightDirections(sceneWith({source}), 4); }), Contains("pixel 1, 1"));
}
