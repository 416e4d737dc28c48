// Light at voxels: closed forms, and what must not change it.
// SPDX-License-Identifier: Apache-2.0

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "light/lit_medium.h"
#include "support/field_bricks.h"
#include "support/test_scenes.h"
#include "umbrick/core/error.h"
#include "umbrick/optics/directions.h"

using namespace umbrick;

namespace {

const IndexBox kBox{glm::ivec3(0), glm::ivec3(39)};

std::vector<LightDirection> cone(const glm::dvec3& axis, int count) {
  std::vector<LightDirection> result;
  for (const WeightedDirection& one : spiralDirections(axis, 60 * kDegree, count))
    result.push_back({one.direction, glm::dvec3(one.weight)});
  return result;
}

double ball(const glm::dvec3& p, const glm::dvec3& centre, double radius) {
  return std::max(0.0, 1 - glm::length(p - centre) / radius);
}
double twoBalls(const glm::ivec3& i) {
  const glm::dvec3 p(i);
  return std::max(ball(p, {10, 12, 14}, 9), ball(p, {28, 22, 24}, 10));
}

template <class Visit>
void forEachVoxel(const Visit& visit) {
  for (int z = 0; z < 40; ++z)
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x) visit(glm::ivec3(x, y, z));
}

}  // namespace

TEST_CASE("A solid that a plane cuts dims light from the plane on", "[light]") {
  const double sigma_t = 0.2;
  const FieldBricks volume([](const glm::ivec3&) { return 1.0; }, kBox);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, 0.2, -1));  // inwards: light comes from +z
  const double offset = -glm::dot(normal, glm::dvec3(20, 20, 28.37));
  for (const glm::dvec3& towards : {glm::dvec3(0, 0, 1), glm::dvec3(0.4, -0.3, 0.9), glm::dvec3(-0.8, 0.1, 0.6)}) {
    const glm::dvec3 direction = glm::normalize(towards);
    LightMedium medium = mediumOf(volume, proportional(sigma_t), {{direction, glm::dvec3(1)}});
    medium.planes.emplace_back(normal, offset);
    const LitVoxels lit(volume, medium);
    double worst = 0;
    // Away from the faces of the block, where its own border counts.
    for (int z = 12; z < 33; ++z)
      for (int y = 17; y < 24; ++y)
        for (int x = 17; x < 24; ++x) {
          const glm::dvec3 p(x, y, z);
          const double inside = (glm::dot(normal, p) + offset) / -glm::dot(normal, direction);  // along the path
          if (inside < 0 || inside > 12) continue;  // outside, light is such that it looks right at the plane
          worst = std::max(worst, std::abs(lit.at({x, y, z}) - std::exp(-sigma_t * inside)));
        }
    INFO("light from " << towards.x << ", " << towards.y << ", " << towards.z);
    // Interpolation between paths, whose optical depths differ by at most sigma_t a voxel, is off by sigma_t^2 / 8
    // along each of two axes.
    CHECK(worst < 0.25 * sigma_t * sigma_t);
  }
}

TEST_CASE("Nothing dims light where there is no medium in its way", "[light]") {
  const FieldBricks volume(twoBalls, kBox);
  // From above; the upper half of the higher ball's surroundings sees the light whole.
  const LitVoxels lit(volume, mediumOf(volume, proportional(0.5), cone({0, 0, 1}, 24)));
  CHECK(lit.at({28, 22, 35}) == Approx(1).margin(1e-6));
  CHECK(lit.at({28, 22, 24}) < 0.6);
}

TEST_CASE("Light is the same however the volume is cut into bricks", "[light]") {
  const auto transfer = proportional(0.6);
  FieldOptions small, large;
  small.interior = 8;
  large.interior = 40;
  const FieldBricks bricked(twoBalls, kBox, small), whole(twoBalls, kBox, large);
  CHECK(bricked.bricks.size() > 20);
  for (const glm::dvec3& axis : {glm::dvec3(0, 0, 1), glm::dvec3(-0.5, 0.8, 0.3), glm::dvec3(0.9, -0.2, -0.4)}) {
    const LitVoxels a(bricked, mediumOf(bricked, transfer, cone(axis, 20)));
    const LitVoxels b(whole, mediumOf(whole, transfer, cone(axis, 20)));
    double worst = 0;
    // Where there is medium next to a voxel, both must have light.
    forEachVoxel([&](const glm::ivec3& p) {
      if (twoBalls(p) > 0) worst = std::max(worst, std::abs(a.at(p) - b.at(p)));
    });
    CHECK(worst < 1.01 / 65535);  // a step: sums of up to 40 optical depths in single precision round either way
  }
}

TEST_CASE("Bricks that show nothing change no light", "[light]") {
  const auto transfer = proportional(0.6);
  const FieldBricks volume(twoBalls, kBox);
  LightMedium all = mediumOf(volume, transfer, cone({0.2, 0.3, 1}, 12));
  const LightMedium visible = all;
  for (int x = 0; x < 40; x += 8)
    if (std::ranges::find(all.cells, glm::ivec3(x, 32, 0)) == all.cells.end()) all.cells.emplace_back(x, 32, 0);
  REQUIRE(all.cells.size() > visible.cells.size());
  const LitVoxels a(volume, visible), b(volume, all);
  double worst = 0;
  forEachVoxel([&](const glm::ivec3& p) {
    if (twoBalls(p) > 0) worst = std::max(worst, std::abs(a.at(p) - b.at(p)));
  });
  CHECK(worst == 0);
}

TEST_CASE("Light is computed again only where something changed", "[light]") {
  const FieldBricks volume(twoBalls, kBox);
  LightVolume light(volume);
  LightMedium medium = mediumOf(volume, proportional(0.5), cone({0, 0, 1}, 8));
  CHECK(light.update(medium, kPlenty));
  CHECK_FALSE(light.update(medium, kPlenty));
  medium.transfer = proportional(0.7);
  CHECK(light.update(medium, kPlenty));
  medium.planes.emplace_back(0, 0, -1, 20);
  CHECK(light.update(medium, kPlenty));
  medium.directions.pop_back();
  CHECK(light.update(medium, kPlenty));
  CHECK_FALSE(light.update(medium, kPlenty));
  CHECK_THROWS_AS(light.update(mediumOf(volume, proportional(0.1), cone({0, 0, 1}, 8)), 1000), InvalidArgument);
  // What was refused is not what is held, so that nothing stale is read.
  CHECK(light.update(medium, kPlenty));
  std::vector<float> block(volume.layout.voxels());
  CHECK_THROWS_AS(light.read({4000, 0, 0}, block), InvalidArgument);
}

TEST_CASE("Lights of several colours have three channels", "[light]") {
  const FieldBricks volume(twoBalls, kBox);
  const auto transfer = proportional(0.5);
  const glm::dvec3 above(0, 0, 1), side(1, 0, 0);
  const LitVoxels both(volume, mediumOf(volume, transfer, {{above, {1, 0.5, 0}}, {side, {0, 0.5, 2}}}));
  const LitVoxels fromAbove(volume, mediumOf(volume, transfer, {{above, glm::dvec3(1)}}));
  const LitVoxels fromSide(volume, mediumOf(volume, transfer, {{side, glm::dvec3(1)}}));
  REQUIRE(both.light().channels() == 3);
  CHECK(fromAbove.light().channels() == 1);
  CHECK(both.light().whole() == glm::dvec3(1, 1, 2));
  for (const glm::ivec3& p : {glm::ivec3(10, 12, 14), glm::ivec3(28, 22, 20), glm::ivec3(24, 20, 24)}) {
    // Light is rounded to steps of 1/65535.
    CHECK(both.at(p, 0) == Approx(fromAbove.at(p)).margin(1e-6));
    CHECK(both.at(p, 1) == Approx(0.5 * (fromAbove.at(p) + fromSide.at(p))).margin(1.1 / 65535));
    CHECK(both.at(p, 2) == Approx(fromSide.at(p)).margin(1e-6));
  }
}

TEST_CASE("The error of light falls with the square of a voxel's edge", "[light]") {
  // A ball whose density is smooth, at three resolutions of one world.
  const glm::dvec3 centre(20, 19, 21), direction = glm::normalize(glm::dvec3(0.35, -0.5, 0.8));
  const auto density = [&](const glm::dvec3& p) {
    const double r2 = glm::dot(p - centre, p - centre) / 144;
    return r2 < 1 ? (1 - r2) * (1 - r2) * (1 - r2) : 0.0;
  };
  const double sigma_t = 0.3;
  const auto exact = [&](const glm::dvec3& p) {
    double tau = 0;
    constexpr double kStep = 0.01;
    for (double t = 0.5 * kStep; t < 30; t += kStep) tau += sigma_t * density(p + t * direction) * kStep;
    return std::exp(-tau);
  };
  std::vector<double> errors;
  for (const int perUnit : {1, 2}) {
    const double edge = 0.8 / perUnit;
    FieldOptions options;
    options.indexToWorld = glm::scale(glm::dmat4(1), glm::dvec3(edge));
    const int last = static_cast<int>(40 / edge);
    const FieldBricks volume([&](const glm::ivec3& i) { return density(edge * glm::dvec3(i)); },
                             {glm::ivec3(0), glm::ivec3(last)}, options);
    const LitVoxels lit(volume, mediumOf(volume, proportional(sigma_t), {{direction, glm::dvec3(1)}}));
    double sum = 0;
    int count = 0;
    for (int z = 12; z < 30; z += 3)
      for (int y = 12; y < 30; y += 3)
        for (int x = 12; x < 30; x += 3) {
          const glm::dvec3 p = glm::dvec3(x, y, z) * 0.8;
          if (density(p) < 0.01) continue;
          const double error = lit.at(glm::ivec3(x, y, z) * perUnit) - exact(p);
          sum += error * error;
          ++count;
        }
    REQUIRE(count > 50);
    errors.push_back(std::sqrt(sum / count));
  }
  INFO("errors " << errors[0] << " and " << errors[1]);
  CHECK(errors[0] < 4e-3);
  CHECK(errors[0] > 3.2 * errors[1]);  // 4 for the second order
}

TEST_CASE("A function of a single point or step dims light wherever it lies, whatever the values", "[light]") {
  const Medium medium{glm::dvec3(1), 0.15}, none{glm::dvec3(1), 0};
  const double step = GENERATE(0.0, 1e-20, 1.0, -3e5), unit = GENERATE(1e-6, 1.0, 1e6);
  INFO("at " << step << ", values of some " << unit);
  // All on one side of the step, or half of the voxels on each.
  const auto lightOf = [&](const TransferFunction& function, double middle) {
    const FieldBricks volume([&](const glm::ivec3& i) { return middle + unit * (i.z - 15.5); },
                             {glm::ivec3(0), glm::ivec3(31)});
    LightVolume light(volume);
    const LightMedium lit = mediumOf(volume, function, {{glm::dvec3(0, 0, 1), glm::dvec3(1)}});
    REQUIRE(light.update(lit, kPlenty));
    std::vector<float> all, one(volume.layout.voxels());
    for (const glm::ivec3& cell : lit.cells) {
      light.read(cell, one);
      all.insert(all.end(), one.begin(), one.end());
    }
    return all;
  };
  const auto differ = [](const std::vector<float>& a, const std::vector<float>& b) {
    REQUIRE(a.size() == b.size());
    float worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
    return worst;
  };
  // The same everywhere: as two points far off.
  const std::vector<float> one = lightOf(TransferFunction({{step, medium}}), step);
  const double far = 100 * unit + std::abs(step);
  CHECK(*std::ranges::min_element(one) < 0.05);
  CHECK(differ(one, lightOf(TransferFunction({{-far, medium}, {far, medium}}), step)) < 2.0 / 65535);
  if (std::abs(step) > 1e3 * unit) return;  // single precision has no voxels on both sides
  // A step: as a ramp over a thousandth of what voxels differ by.
  const std::vector<float> stepped = lightOf(TransferFunction({{step, none}, {step, medium}}), step);
  CHECK(differ(stepped, lightOf(TransferFunction({{step - 5e-4 * unit, none}, {step + 5e-4 * unit, medium}}), step)) <
        1e-3);
}
