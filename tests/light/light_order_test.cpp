// How fast the error of light falls: with the number of directions, and with the distance of paths. That with the
// edge of the voxels is in light_volume_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "light/lit_medium.h"
#include "support/field_bricks.h"
#include "support/observed_order.h"
#include "support/test_scenes.h"
#include "umbrick/optics/directions.h"

using namespace umbrick;

namespace {

constexpr int kEdge = 64;

// The light at voxels of one brick.
class Light {
 public:
  Light(const FieldBricks& volume, const LightMedium& medium) : light_(volume), edge_(volume.layout.edge().x) {
    light_.update(medium, std::uint64_t{1} << 32);
    block_.resize(volume.layout.voxels());
    light_.read({0, 0, 0}, block_);
  }
  double at(const glm::ivec3& p) const {
    const glm::ivec3 i = p + 1;
    return double{block_[static_cast<std::size_t>((i.z * edge_ + i.y) * edge_ + i.x)]};
  }

 private:
  LightVolume light_;
  int edge_;
  std::vector<float> block_;
};

}  // namespace

TEST_CASE("The error of light falls with the square of the number of directions in a layered medium", "[light]") {
  // Under a plane that cuts a solid, light depends on a direction's cosine alone. spiralDirections() takes the middles
  // of equal steps of the cosine: the rule of midpoints, of the second order. All go along z most, so that their paths
  // on a slice are alike, and nothing is lost between these.
  const double sigma_t = 0.15, aperture = 44 * kDegree;
  const FieldBricks volume([](const glm::ivec3&) { return 1.0; }, {glm::ivec3(0), glm::ivec3(kEdge - 1)},
                           FieldOptions{.interior = kEdge});
  std::vector<double> steps, errors;
  for (const int count : {2, 4, 8}) {
    LightMedium medium{proportional(sigma_t), {}, {{0, 0, -1, 40}}, {{0, 0, 0}}};
    for (const WeightedDirection& one : spiralDirections({0, 0, 1}, aperture, count))
      medium.directions.push_back({one.direction, glm::dvec3(one.weight)});
    const Light light(volume, medium);
    double worst = 0;
    for (const int depth : {4, 8, 18}) {
      double exact = 0;
      constexpr int kParts = 10000;
      const double low = std::cos(aperture);
      for (int i = 0; i < kParts; ++i)
        exact += std::exp(-sigma_t * depth / (low + (1 - low) * (i + 0.5) / kParts)) / kParts;
      worst = std::max(worst, std::abs(light.at({32, 32, 40 - depth}) - exact));
    }
    steps.push_back(1.0 / count);
    errors.push_back(worst);
  }
  INFO("errors " << errors[0] << ", " << errors[1] << ", " << errors[2]);
  // The steps of codes, 1.6e-5 each, count for the last.
  CHECK(observedOrder(steps, errors) == Approx(2).margin(0.4));
}

TEST_CASE("The error of light falls with the square of the distance of paths", "[light]") {
  // sigma_t that changes across the direction of light only, so that nothing but the interpolation between paths is
  // off: voxels are at the middle of four paths, where that is most.
  std::vector<double> steps, errors;
  for (const double wave : {32.0, 16.0, 8.0}) {
    const auto across = [&](double x, double y) {
      return 0.5 + 0.25 * std::sin(2 * std::numbers::pi * x / wave) + 0.25 * std::cos(2 * std::numbers::pi * y / wave);
    };
    const FieldBricks volume([&](const glm::ivec3& p) { return across(p.x, p.y); },
                             {glm::ivec3(0), glm::ivec3(kEdge - 1)}, FieldOptions{.interior = kEdge});
    // Every path runs along z: paths lie on voxels, or, where light is held at every second voxel, on every second.
    LightMedium medium{proportional(0.1), {{glm::dvec3(0, 0, 1), glm::dvec3(1)}}, {{0, 0, -1, 40}}, {{0, 0, 0}}, 2};
    const Light second(volume, medium);
    medium.spacing = 1;
    const Light each(volume, medium);
    double sum = 0, onVoxels = 0;
    int count = 0;
    for (int y = 10; y < 50; ++y)
      for (int x = 10; x < 50; ++x)
        for (const int z : {30, 36}) {
          const double exact = std::exp(-0.1 * across(x, y) * (40 - z));
          onVoxels = std::max(onVoxels, std::abs(each.at({x, y, z}) - exact));
          const double error = second.at({x, y, z}) - exact;
          sum += error * error;
          ++count;
        }
    // Nothing is between paths and voxels: half a step of the table's 4088 and codes remain.
    CHECK(onVoxels < 1.5e-4);
    steps.push_back(2 / wave);
    errors.push_back(std::sqrt(sum / count));
  }
  INFO("errors " << errors[0] << ", " << errors[1] << ", " << errors[2]);
  CHECK(observedOrder(steps, errors) == Approx(2).margin(0.2));
}
