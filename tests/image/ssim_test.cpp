// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/ssim.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "image/formula_pictures.h"
#include "umbrick/core/error.h"
#include "umbrick/core/srgb.h"

using namespace umbrick;
using Catch::Contains;

// The numbers are from scikit-image 0.19.3: structural_similarity(reference, test, gaussian_weights=True, sigma=1.5,
// use_sample_covariance=False, data_range=1) of the pictures' Rec. 709 luminance encoded as sRGB.
TEST_CASE("SSIM has the values of scikit-image", "[image]") {
  const auto ssim = [](Formula test, Formula reference) {
    return meanSsim(formulaPicture(test), formulaPicture(reference));
  };
  // Both compute in double precision. Variances as differences of squares lose four digits of sixteen.
  const double tolerance = 1e-11;
  CHECK(ssim(Formula::shifted, Formula::smooth) == Approx(0.957192168452).margin(tolerance));
  CHECK(ssim(Formula::waves, Formula::checks) == Approx(-0.462695835564).margin(tolerance));
  CHECK(ssim(Formula::noise, Formula::flat) == Approx(0.022015693865).margin(tolerance));
  CHECK(ssim(Formula::noise, Formula::smooth) == Approx(0.021106610302).margin(tolerance));
}

TEST_CASE("SSIM of a picture and itself is 1, and order does not matter", "[image]") {
  for (const Formula formula : {Formula::smooth, Formula::noise, Formula::flat})
    CHECK(meanSsim(formulaPicture(formula), formulaPicture(formula)) == 1);
  const Image a = formulaPicture(Formula::noise), b = formulaPicture(Formula::waves);
  CHECK(meanSsim(a, b) == meanSsim(b, a));
  CHECK(std::abs(meanSsim(a, b)) < 1);
}

// Without structure only the means are left: (2 a b + C1) / (a^2 + b^2 + C1).
TEST_CASE("SSIM of two greys has its closed form", "[image]") {
  const float dark = 0.1f, light = 0.6f;
  const double a = linearToSrgb(dark), b = linearToSrgb(light), steady = 1e-4;
  CHECK(meanSsim(solid(11, 12, dark, dark, dark), solid(11, 12, light, light, light)) ==
        Approx((2 * a * b + steady) / (a * a + b * b + steady)).epsilon(1e-9));
}

TEST_CASE("SSIM compares what a screen shows", "[image]") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Image white = solid(11, 11, 1, 1, 1);
  CHECK(meanSsim(solid(11, 11, 0, 0, 0, 0), white, glm::dvec3(1)) == 1);
  CHECK(meanSsim(solid(11, 11, 9, 2, 1), white) == 1);
  CHECK(meanSsim(solid(11, 11, nan, -1, 0), solid(11, 11, 0, 0, 0)) == 1);
}

TEST_CASE("SSIM refuses pictures that it cannot compare, and a background out of range", "[image]") {
  const Image a(11, 11, 4);
  CHECK_THROWS_WITH(meanSsim(a, Image(12, 11, 4)), Contains("11 x 11 beside 12 x 11 pixels"));
  CHECK_THROWS_WITH(meanSsim(a, Image(11, 11, 3)), Contains("4 beside 3 channels"));
  CHECK_THROWS_WITH(meanSsim(Image(11, 11, 1), Image(11, 11, 1)), Contains("expected 3 or 4 channels, found 1"));
  CHECK_THROWS_WITH(meanSsim(Image(10, 11, 4), Image(10, 11, 4)), Contains("at least 11 x 11 pixels, found 10 x 11"));
  CHECK_THROWS_WITH(meanSsim(a, a, glm::dvec3(-1, 0, 0)), Contains("background"));
}
