// The two ways to take gradients of voxels.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <vector>

#include "umbrick/core/random.h"
#include "umbrick/optics/bspline.h"
#include "umbrick/optics/gradient_filter.h"

using namespace umbrick;

namespace {

// The gradient at the middle of 3 x 3 x 3 voxels around a place.
template <class Field>
glm::dvec3 gradientOf(const Field& field, const glm::dvec3& place, GradientFilter filter) {
  std::array<float, 27> voxels;
  for (int i = 0; i < 27; ++i)
    voxels[static_cast<std::size_t>(i)] = static_cast<float>(field(place + glm::dvec3(i % 3, i / 3 % 3, i / 9) - 1.0));
  return 0.5 * differencesAt(&voxels[13], 3, 9, filter);
}

constexpr GradientFilter kBoth[]{GradientFilter::central, GradientFilter::bspline};

}  // namespace

TEST_CASE("Weights of a cubic B-spline keep polynomials, and its slopes are their slopes", "[optics]") {
  for (int step = 0; step <= 16; ++step) {
    const float t = static_cast<float>(step) / 16;
    const glm::vec4 weights = bsplineWeights(t), slopes = bsplineSlopes(t);
    const glm::vec4 knots(-1, 0, 1, 2);
    CHECK(glm::dot(weights, glm::vec4(1)) == Approx(1));
    CHECK(glm::dot(weights, knots) == Approx(t).margin(1e-6));
    CHECK(glm::dot(slopes, glm::vec4(1)) == Approx(0).margin(1e-6));
    CHECK(glm::dot(slopes, knots) == Approx(1));
    CHECK(glm::dot(slopes, knots * knots) == Approx(2 * t).margin(1e-6));
    // A spline of coefficients k^3 is x^3 + x.
    CHECK(glm::dot(weights, knots * knots * knots) == Approx(t * t * t + t).margin(1e-6));
    CHECK(glm::dot(slopes, knots * knots * knots) == Approx(3 * t * t + 1));
    for (int i = 0; i < 4; ++i) CHECK(weights[i] >= 0);
  }
}

TEST_CASE("Gradients of both kinds are exact for polynomials of degree 2", "[optics]") {
  const glm::dvec3 slope(0.75, -0.5, 1.25), place(4, -3, 7);
  const glm::dmat3 curve(0.5, 0.25, -1, 0.25, 2, 0.75, -1, 0.75, -0.5);  // symmetric; all numbers are exact
  const auto field = [&](const glm::dvec3& p) { return glm::dot(slope, p) + 0.5 * glm::dot(p, curve * p); };
  for (const GradientFilter filter : kBoth)
    CHECK(glm::length(gradientOf(field, place, filter) - (slope + curve * place)) < 1e-12);
}

TEST_CASE("Gradients of both kinds are 3 x^2 + 1 of x^3", "[optics]") {
  for (const GradientFilter filter : kBoth)
    for (const double x : {-2.0, 0.0, 5.0})
      CHECK(gradientOf([](const glm::dvec3& p) { return p.y * p.y * p.y; }, {1, x, 2}, filter) ==
            glm::dvec3(0, 3 * x * x + 1, 0));
}

// The variance of a difference is twice that of a voxel; a mean with weights 1/6, 4/6 and 1/6 along both other axes has
// half of the variance for each.
TEST_CASE("B-splines halve the gradient of noise", "[optics]") {
  Random noisy(11);
  constexpr int kEdge = 48;
  std::vector<float> noise(kEdge * kEdge * kEdge);
  for (float& voxel : noise) voxel = static_cast<float>(noisy.uniform());
  std::array<double, 2> power{};
  for (int z = 1; z + 1 < kEdge; ++z)
    for (int y = 1; y + 1 < kEdge; ++y)
      for (int x = 1; x + 1 < kEdge; ++x)
        for (std::size_t i = 0; i < 2; ++i) {
          const glm::dvec3 d = differencesAt(&noise[static_cast<std::size_t>((z * kEdge + y) * kEdge + x)], kEdge,
                                             kEdge * kEdge, kBoth[i]);
          power[i] += glm::dot(d, d);
        }
  // Of 292 008 numbers each, of which a few depend on another: 1 percent is 4 standard errors.
  CHECK(std::sqrt(power[1] / power[0]) == Approx(0.5).epsilon(0.01));
}
