// Light where a plane cuts through solid medium: closed forms.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "support/field_bricks.h"
#include "support/test_scenes.h"
#include "umbrick/core/random.h"
#include "umbrick/light/light_volume.h"

using namespace umbrick;

namespace {

constexpr int kSize = 40;

// A solid of one value, and the light in it, read between voxels as renderers read it.
class CutSolid {
 public:
  CutSolid(double sigma_t, const glm::dvec3& light, const glm::dvec4& plane) : light_(bricks()) {
    LightMedium medium{
        TransferFunction({{0, {glm::dvec3(1), 0}}, {1, {glm::dvec3(1), sigma_t}}}), {{light, glm::dvec3(1)}}, {}, {}};
    medium.planes.push_back(plane);
    medium.cells.emplace_back(0, 0, 0);
    light_.update(medium, std::uint64_t{1} << 30);
    block_.resize(bricks().layout.voxels());
    light_.read({0, 0, 0}, block_);
  }
  double operator()(const glm::dvec3& index) const {
    const glm::dvec3 low = glm::floor(index), f = index - low;
    double sum = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
      const glm::ivec3 offset(corner & 1, corner >> 1 & 1, corner >> 2 & 1), p = glm::ivec3(low) + offset + 1;
      double weight = 1;
      for (int axis = 0; axis < 3; ++axis) weight *= offset[axis] ? f[axis] : 1 - f[axis];
      sum += weight * double{block_[static_cast<std::size_t>((p.z * (kSize + 2) + p.y) * (kSize + 2) + p.x)]};
    }
    return sum;
  }

 private:
  static const FieldBricks& bricks() {
    static const FieldBricks one([](const glm::ivec3&) { return 1.0; }, {glm::ivec3(0), glm::ivec3(kSize - 1)},
                                 FieldOptions{.interior = kSize});
    return one;
  }
  LightVolume light_;
  std::vector<float> block_;
};

struct Errors {
  double atCut = 0, seen = 0;  // root mean squares
};

// Light on the plane, which is 1, and what an eye sees that looks straight at it: the mean of light over the way,
// weighted by sigma_t exp(-sigma_t way). Light that comes at an angle with the plane's normal has this cosine.
Errors errorsAt(double sigma_t, const glm::dvec3& light, const glm::dvec3& inwards, Random& random) {
  const glm::dvec3 normal = glm::normalize(inwards), direction = glm::normalize(light);
  const double cosine = -glm::dot(normal, direction);
  REQUIRE(cosine > 0.1);
  Errors errors;
  int count = 0;
  for (int place = 0; place < 4; ++place) {
    // The middle of the plane, so that the way of light from the border of the solid counts nowhere.
    const glm::dvec3 middle(20 + 0.9 * random.uniform(), 20 + 0.9 * random.uniform(), 20 + 0.9 * random.uniform());
    const CutSolid solid(sigma_t, direction, {normal, -glm::dot(normal, middle)});
    const glm::dvec3 across = glm::normalize(glm::cross(normal, glm::dvec3(0.3, 0.5, 0.8)));
    const glm::dvec3 along = glm::cross(normal, across);
    for (int i = 0; i < 50; ++i) {
      const glm::dvec3 p = middle + (6 * random.uniform() - 3) * across + (6 * random.uniform() - 3) * along;
      const double cut = solid(p) - 1;
      double seen = 0;
      constexpr int kSteps = 200;
      const double reach = std::min(6.0, 8 / sigma_t), step = reach / kSteps;
      for (int k = 0; k < kSteps; ++k) {
        const double way = (k + 0.5) * step;
        seen +=
            (solid(p + way * normal) - std::exp(-sigma_t * way / cosine)) * sigma_t * std::exp(-sigma_t * way) * step;
      }
      errors.atCut += cut * cut;
      errors.seen += seen * seen;
      ++count;
    }
  }
  return {std::sqrt(errors.atCut / count), std::sqrt(errors.seen / count)};
}

}  // namespace

TEST_CASE("Light at a cut is as bright as it arrives there", "[light]") {
  Random random(5);
  struct Case {
    double sigma_t, straight, slanting;  // what is seen may be off by so much
  };
  // Half-way between voxels a straight line is above an exponential by up to sigma_t^2 / 8 a voxel. Of this the first
  // voxel within the cut, which the eye sees most of, is corrected; of 5 a voxel nothing is seen of the others.
  for (const Case& one :
       {Case{0.2, 0.004, 0.02}, {0.5, 0.012, 0.06}, {0.8, 0.02, 0.08}, {2, 0.08, 0.25}, {5, 0.2, 0.3}}) {
    for (const glm::dvec3& inwards : {glm::dvec3(0, 0, -1), glm::dvec3(0.3, 0.2, -1), glm::dvec3(0, 1, 0)}) {
      INFO("sigma_t " << one.sigma_t << ", inwards " << inwards.x << ", " << inwards.y << ", " << inwards.z);
      const glm::dvec3 out = -glm::normalize(inwards);
      CHECK(errorsAt(one.sigma_t, out, inwards, random).seen < one.straight);
      // 30 degrees, and 50.
      const glm::dvec3 across = glm::normalize(glm::cross(out, glm::dvec3(0.5, -0.4, 0.3)));
      CHECK(errorsAt(one.sigma_t, out + 0.58 * across, inwards, random).seen < 1.6 * one.straight);
      CHECK(errorsAt(one.sigma_t, out + 1.19 * across, inwards, random).seen < one.slanting);
    }
  }
}

TEST_CASE("Light at a cut along voxels is right at the cut where the medium is thin", "[light]") {
  Random random(2);
  // What is added for the eye is of the second order, too.
  std::vector<double> errors;
  for (const double sigma_t : {0.05, 0.1, 0.2})
    errors.push_back(errorsAt(sigma_t, {0, 0, 1}, {0, 0, -1}, random).atCut);
  INFO(errors[0] << ", " << errors[1] << ", " << errors[2]);
  CHECK(errors[2] < 0.003);
  CHECK(errors[2] > 2.5 * errors[1]);
  CHECK(errors[1] > 2.5 * errors[0]);
}

TEST_CASE("Light behind a medium is what the medium lets through", "[light]") {
  Random random(3);
  // A layer of 6 voxels between two planes.
  const double sigma_t = 0.3;
  const FieldBricks solid([](const glm::ivec3&) { return 1.0; }, {glm::ivec3(0), glm::ivec3(31)},
                          FieldOptions{.interior = 32});
  LightVolume light(solid);
  LightMedium medium{TransferFunction({{0, {glm::dvec3(1), 0}}, {1, {glm::dvec3(1), sigma_t}}}),
                     {{glm::dvec3(0, 0, 1), glm::dvec3(1)}},
                     {{0, 0, -1, 20.3}, {0, 0, 1, -14.3}},
                     {{0, 0, 0}}};
  light.update(medium, std::uint64_t{1} << 30);
  std::vector<float> block(solid.layout.voxels());
  light.read({0, 0, 0}, block);
  const auto at = [&](int z) { return double{block[static_cast<std::size_t>(((z + 1) * 34 + 17) * 34 + 17)]}; };
  CHECK(at(25) == Approx(1).margin(1e-4));
  CHECK(at(20) == Approx(std::exp(-0.3 * sigma_t)).margin(1e-4));
  CHECK(at(15) == Approx(std::exp(-5.3 * sigma_t)).margin(1e-4));
  // It goes on falling for two slices, so that what is read at the plane is right.
  CHECK(at(14) == Approx(std::exp(-6.3 * sigma_t)).margin(1e-4));
}
