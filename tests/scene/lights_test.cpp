// SPDX-License-Identifier: Apache-2.0
#include "umbrick/scene/lights.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "scene/lights_scene.h"
#include "support/closed_forms.h"
#include "support/complaint.h"
#include "umbrick/core/error.h"
#include "umbrick/core/random.h"

using namespace umbrick;
using Catch::Contains;

namespace {

LightSource cone(const glm::dvec3& axis, double degrees, const glm::dvec3& radiance) {
  return {LightFrame::view, ConeLight{axis, degrees * std::numbers::pi / 180, radiance}};
}

// Returns one channel of the integral of the light times a function of the direction.
double appliedChannel(const std::vector<LightDirection>& directions, const std::function<double(const glm::dvec3&)>& f,
                      int channel = 0) {
  double sum = 0;
  for (const LightDirection& light : directions) sum += light.radiance[channel] * f(light.direction);
  return sum;
}

// Returns the light that has passed a slab of unit depth which faces `axis`: smooth, and not symmetric
// around other axes.
std::function<double(const glm::dvec3&)> throughSlab(const glm::dvec3& axis) {
  return [axis](const glm::dvec3& w) { return std::exp(-1 / std::max(1e-9, glm::dot(w, axis))); };
}

double largestDifference(const std::vector<LightDirection>& a, const std::vector<LightDirection>& b) {
  if (a.size() != b.size()) return 1e9;
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    largest =
        std::max({largest, glm::length(a[i].direction - b[i].direction), glm::length(a[i].radiance - b[i].radiance)});
  return largest;
}

}  // namespace

TEST_CASE("A cone around the view axis is the model cone, in lists and in samples", "[scene]") {
  for (const double degrees : {0.0, 25.0, 89.0}) {
    const ResolvedScene lights = sceneWith({cone({0, 0, 2}, degrees, glm::dvec3(1))});
    ResolvedScene same = lights;
    same.model = Model::cone;
    same.occlusion.aperture = degrees * std::numbers::pi / 180;
    CHECK(largestDifference(lightDirections(lights, 37, 0.3), lightDirections(same, 37, 0.3)) == 0);
    CHECK(largestDifference(lightSamples(lights, 50, 25, 7), lightSamples(same, 50, 25, 7)) == 0);
    // This is the quadrature of optics as it is, in the coordinates of the view.
    const CameraFrame frame = cameraFrame(same.camera);
    const glm::dmat3 viewToWorld(frame.right, frame.up, -frame.forward);
    for (const int count : {37, 137}) {
      const auto plain = count <= 64 ? spiralDirections({0, 0, 1}, same.occlusion.aperture, count, 0.3)
                                     : coneDirections({0, 0, 1}, same.occlusion.aperture, count, 0.3);
      const auto list = lightDirections(same, count, 0.3);
      REQUIRE(list.size() == plain.size());
      for (std::size_t i = 0; i < list.size(); ++i) {
        CHECK(glm::length(list[i].direction - viewToWorld * plain[i].direction) < 1e-15);
        CHECK(list[i].radiance == glm::dvec3(plain[i].weight));
      }
    }
  }
}

// Otherwise its shadows would turn around the view axis as the camera does, and jump where tangents change.
TEST_CASE("A cone that moves with the camera keeps its directions, seen from there", "[scene]") {
  ResolvedScene scene = sceneWith({cone({0.3, -0.1, 1}, 40, glm::dvec3(1)), cone({0, 0, 1}, 20, glm::dvec3(2))});
  const auto seen = [&] {
    const CameraFrame frame = cameraFrame(scene.camera);
    const glm::dmat3 worldToView = glm::transpose(glm::dmat3(frame.right, frame.up, -frame.forward));
    std::vector<LightDirection> list = lightDirections(scene, 30, 0.3);
    for (const LightDirection& light : lightSamples(scene, 0, 20, 3)) list.push_back(light);
    for (LightDirection& light : list) light.direction = worldToView * light.direction;
    return list;
  };
  const std::vector<LightDirection> first = seen();
  for (const glm::dvec3& eye : {glm::dvec3(-5, 2, 1), glm::dvec3(0.5, 1.1, -9), glm::dvec3(4, -7, -1.0001)}) {
    scene.camera.eye = eye;
    CHECK(largestDifference(seen(), first) < 2e-15);  // matrices and their products are rounded
  }
}

TEST_CASE("Radiances add up to the light, and each source has directions in its cone", "[scene]") {
  const glm::dvec3 red(3, 0.2, 0.1), blue(0.1, 0.2, 0.5);
  const std::vector<LightSource> sources{
      cone({1, 0, 1}, 30, red),
      cone({-1, 0.5, 2}, 0, blue),
      cone({0, 0, 1}, 80, glm::dvec3(0.25)),
      {LightFrame::view, ListedLight{{{{0, 3, 4}, 0.5, red}, {{0, 0, 0.1}, 2, blue}}}}};
  const ResolvedScene scene = sceneWith(sources);
  const glm::dvec3 expected = red + blue + glm::dvec3(0.25) + 0.5 * red + 2.0 * blue;
  for (const int count : {1, 4, 30, 500}) {
    const auto list = lightDirections(scene, count, 1.1), samples = lightSamples(scene, 3, count, 4);
    // Each source has at least one direction, the list has its two; rings round their share.
    CHECK(static_cast<int>(list.size()) >= std::max(5, count * 9 / 10));
    CHECK(static_cast<int>(list.size()) <= std::max(5, count * 11 / 10 + 2));
    CHECK(glm::length(total(list) - expected) < 1e-13);
    CHECK(glm::length(total(samples) - expected) < 1e-13);
    for (const auto& lights : {list, samples})
      for (const LightDirection& light : lights) {
        CHECK(glm::length(light.direction) == Approx(1).epsilon(1e-14));
        CHECK(glm::dot(light.direction, towardsViewer(scene)) > 0);
      }
  }
  // Of two cones of one size, the one that is twice as bright has twice as many directions. Of two cones of one
  // brightness, the one with four times the solid angle has.
  const auto share = [](const LightSource& a, const LightSource& b) {
    const ResolvedScene two = sceneWith({a, b});
    const double sum = static_cast<double>(lightSamples(two, 0, 300, 1).size());
    CHECK(sum == 300);
    int first = 0;
    for (const LightDirection& light : lightSamples(two, 0, 300, 1))
      if (glm::dot(light.direction, cameraFrame(two.camera).right) > 0) ++first;
    return first;
  };
  CHECK(share(cone({1, 0, 1}, 20, glm::dvec3(2)), cone({-1, 0, 1}, 20, glm::dvec3(1))) == 200);
  const double wide = 2 * std::asin(2 * std::sin(10 * std::numbers::pi / 180)) * 180 / std::numbers::pi;
  CHECK(share(cone({1, 0, 1}, wide, glm::dvec3(1)), cone({-1, 0, 1}, 20, glm::dvec3(1))) == 200);
}

TEST_CASE("Listed directions come as they are, whatever the count", "[scene]") {
  const ListedLight listed{
      {{{0.5, -0.25, 0.75}, 0.3, {1, 2, 3}}, {{0, 0, 9}, 0, {1, 1, 1}}, {{-1, 0, 1e-3}, 2, {0, 1, 0}}}};
  const ResolvedScene scene = sceneWith({{LightFrame::view, listed}});
  const CameraFrame frame = cameraFrame(scene.camera);
  for (const int count : {1, 3, 100})
    for (const auto& list : {lightDirections(scene, count, 0.5), lightSamples(scene, 17, count, 3)}) {
      REQUIRE(list.size() == 3);
      for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 d = listed.list[i].direction;
        const glm::dvec3 world = glm::normalize(d.x * frame.right + d.y * frame.up - d.z * frame.forward);
        CHECK(glm::length(list[i].direction - world) < 1e-15);
        CHECK(list[i].radiance == listed.list[i].weight * listed.list[i].colour);
      }
    }
}

TEST_CASE("A light of the view moves with the camera, one of the world stays", "[scene]") {
  ResolvedScene scene = sceneWith({});
  const glm::dvec3 axis = glm::normalize(towardsViewer(scene) + glm::dvec3(0.1, 0.3, -0.1));
  scene.lights = {{LightFrame::world, ConeLight{axis, 0, glm::dvec3(1)}}, cone({0.3, 0, 1}, 0, glm::dvec3(1))};
  const auto before = lightDirections(scene, 2);
  scene.camera.eye += glm::dvec3(0.4, 0.1, -0.3);
  const auto after = lightDirections(scene, 2);
  CHECK(glm::length(before[0].direction - axis) < 1e-15);
  CHECK(glm::length(after[0].direction - axis) < 1e-15);
  const CameraFrame frame = cameraFrame(scene.camera);
  CHECK(glm::length(after[1].direction - glm::normalize(0.3 * frame.right - frame.forward)) < 1e-15);
}

// One set of n points has a smaller error than a random one, and sets that follow each other fill its gaps. A random
// union of 2^j sets has an error of 2^(-j/2) of the first's. The points of R2 have a discrepancy of log(n)^2 / n at
// best. Over seven doublings that asks for an order of 0.7 at least, where the mean of eight seeds smooths what
// single seeds do.
TEST_CASE("Samples that follow each other converge faster than random ones", "[scene][slow]") {
  const ResolvedScene scene =
      sceneWith({cone({0.5, 0.2, 1}, 50, {1, 0.5, 0.2}), cone({-1, 0, 1}, 10, {0.1, 0.2, 0.9})});
  const auto f = throughSlab(towardsViewer(scene));
  const double exact = appliedChannel(lightDirections(scene, 20'000), f);
  const auto error = [&](int sets, int size) {
    double squares = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      double sum = 0;
      for (int set = 0; set < sets; ++set)
        sum += appliedChannel(lightSamples(scene, static_cast<std::uint64_t>(set * size), size, seed), f);
      squares += (sum / sets - exact) * (sum / sets - exact);
    }
    return std::sqrt(squares / 8);
  };
  const double first = error(1, 16), last = error(128, 16);
  const double order = std::log2(first / last) / 7;
  INFO("errors " << first << " and " << last << ", order " << order);
  CHECK(order > 0.7);
  // The union is that of one long set, however it was cut into sets.
  CHECK(error(16, 128) < 2 * last);
}

TEST_CASE("Every set of samples has the light's mean over seeds", "[scene]") {
  const ResolvedScene scene = sceneWith({cone({0.5, 0.2, 1}, 50, {1, 0.5, 0.2}), cone({-1, 0, 1}, 10, {0.1, 0.2, 0.9}),
                                         cone({0, 1, 1}, 0, {0.3, 0.3, 0.1})});
  const auto f = throughSlab(towardsViewer(scene));
  for (const std::uint64_t first : {std::uint64_t(0), std::uint64_t(5), std::uint64_t(1) << 60})
    for (const int count : {1, 8}) {
      // With 4000 seeds, one in 16 000 means is off by four standard errors.
      for (const int channel : {0, 2}) {
        const double exact = appliedChannel(lightDirections(scene, 20'000), f, channel);
        double sum = 0, squares = 0;
        for (std::uint64_t seed = 0; seed < 4000; ++seed) {
          const double x = appliedChannel(lightSamples(scene, first, count, seed), f, channel);
          sum += x;
          squares += x * x;
        }
        const double mean = sum / 4000, error = std::sqrt((squares / 4000 - mean * mean) / 4000);
        CHECK(std::abs(mean - exact) < 4 * error);
      }
    }
}

TEST_CASE("Lights behind the viewer's plane are refused with their angles", "[scene]") {
  const auto message = [](const ResolvedScene& scene) {
    const std::string sampled = complaint<InvalidArgument>([&] { lightSamples(scene, 0, 1, 0); });
    CHECK(sampled == complaint<InvalidArgument>([&] { lightDirections(scene, 4); }));
    return sampled;
  };
  const LightSource good = cone({0, 0, 1}, 89.9, glm::dvec3(1));
  CHECK_NOTHROW(lightDirections(sceneWith({good}), 4));
  CHECK(message(sceneWith({good, cone({1, 0, 1}, 50, glm::dvec3(1))})) ==
        "light.sources[1]: its axis is 45 degrees from the direction to the viewer and its half-angle 50 degrees, "
        "together 95, must be below 90");
  CHECK_THAT(message(sceneWith({cone({1, 0, 0}, 0, glm::dvec3(1))})), Contains("together 90, must be below 90"));
  CHECK(message(sceneWith({good, {LightFrame::view, ListedLight{{{{0, 0, 1}}, {{1, 0, -0.5}}}}}})) ==
        "light.sources[1].list[1].direction: is [1, 0, -0.5], of which -0.5 is towards the viewer, must be above 0");
  // Lights of the view are refused with the scene, lights of the world once the camera has its place.
  CHECK_THROWS_WITH(validateScene(sceneWith({cone({1, 0, 1}, 50, glm::dvec3(1))})), Contains("together 95"));
  ResolvedScene world = sceneWith({});
  world.lights = {{LightFrame::world, ConeLight{-towardsViewer(world), 0, glm::dvec3(1)}}};
  CHECK_NOTHROW(validateScene(world));
  CHECK_THAT(message(world), Contains("together 180, must be below 90 as the camera stands"));
  world.lights = {{LightFrame::world, ListedLight{{{-towardsViewer(world)}}}}};
  CHECK_THAT(message(world), Contains("must be above 0 as the camera stands"));
}

TEST_CASE("Lights behind what is seen are for light volumes", "[scene]") {
  ResolvedScene scene = sceneWith({cone({0.2, 0, -1}, 40, glm::dvec3(1))});
  CHECK_THROWS_WITH(validateScene(scene), Contains("must be below 90"));
  scene.method = Method::lightVolume;
  CHECK_NOTHROW(validateScene(scene));
  for (const LightDirection& light : lightDirections(scene, 16))
    CHECK(glm::dot(light.direction, towardsViewer(scene)) < 0);
}

TEST_CASE("The whole sphere lights evenly, in lists and in samples", "[scene]") {
  ResolvedScene scene = sceneWith({});
  scene.model = Model::ambient;
  scene.method = Method::lightVolume;
  for (const auto& list : {lightDirections(scene, 16), lightDirections(scene, 64, 0.7), lightDirections(scene, 200),
                           lightSamples(scene, 0, 400, 3)}) {
    CHECK(list.size() >= 16);
    CHECK(total(list).r == Approx(1).epsilon(1e-9));
    // 16 directions of equal weight are off by less than a sixteenth.
    for (const glm::dvec3& axis : {glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(0.6, -0.8, 0)}) {
      CHECK(std::abs(applied(list, [&](const glm::dvec3& w) { return glm::dot(w, axis); }).r) < 0.05);
      CHECK(applied(list, [&](const glm::dvec3& w) { return glm::dot(w, axis) * glm::dot(w, axis); }).r ==
            Approx(1.0 / 3).margin(0.05));
    }
  }
}

TEST_CASE("What has no list of directions is refused", "[scene]") {
  ResolvedScene scene = sceneWith({cone({0, 0, 1}, 10, glm::dvec3(1))});
  CHECK(complaint<InvalidArgument>([&] { lightDirections(scene, 0); }) == "directions: expected at least 1, found 0");
  CHECK(complaint<InvalidArgument>([&] { lightSamples(scene, 0, -3, 1); }) ==
        "directions: expected at least 1, found -3");
  for (const Model model : {Model::emission, Model::coneRay}) {
    scene.model = model;
    CHECK_THAT(complaint<InvalidArgument>([&] { lightDirections(scene, 4); }), Contains(modelName(model)));
  }
  scene.model = Model::lights;
  scene.lights.clear();
  CHECK_THAT(complaint<InvalidArgument>([&] { lightDirections(scene, 4); }), Contains("light.sources: is empty"));
}

// Lights that are switched off are black, not NaN.
TEST_CASE("A light without power has directions without radiance", "[scene]") {
  const ResolvedScene scene =
      sceneWith({cone({0, 0, 1}, 30, glm::dvec3(0)), {LightFrame::view, ListedLight{{{{0, 0, 1}, 0}}}}});
  for (const auto& list : {lightDirections(scene, 16), lightSamples(scene, 0, 16, 1)}) {
    CHECK(list.size() >= 2);
    CHECK(total(list) == glm::dvec3(0));
  }
}
