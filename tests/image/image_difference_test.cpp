// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/image_difference.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "image/formula_pictures.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Contains;

namespace {

const float kNan = std::numeric_limits<float>::quiet_NaN();
const float kInfinity = std::numeric_limits<float>::infinity();

Image row(std::vector<float> values) {
  Image image(static_cast<int>(values.size()), 1, 1);
  image.pixels = std::move(values);
  return image;
}

// Returns an image with the errors 1 to `count` against 0, each once, in no obvious order.
Image everyErrorUpTo(int width, int height) {
  Image image(width, height, 1);
  std::iota(image.pixels.begin(), image.pixels.end(), 1.0f);
  std::shuffle(image.pixels.begin(), image.pixels.end(), std::mt19937(5));
  return image;
}

Image scaled(Image image, float factor) {
  for (float& value : image.pixels) value *= factor;
  return image;
}

}  // namespace

TEST_CASE("An image does not differ from itself", "[image]") {
  const Image image = formulaPicture(Formula::noise);
  const ImageDifference difference = differenceOf(image, image);
  CHECK(difference.rmse == 0);
  CHECK(difference.rmseRgb == 0);
  CHECK(difference.maxError == 0);
  CHECK(difference.p999 == 0);
  CHECK(difference.relMse == 0);
  CHECK(difference.ssim == 1);
  CHECK(difference.flip == 0);
  CHECK(difference.nonFiniteDiffering + difference.nonFiniteEqual == 0);
}

TEST_CASE("A constant offset of the colour is its own RMSE, maximum and percentile", "[image]") {
  const float offset = 0.0625f;  // sums and squares of these numbers are exact
  const Image reference = solid(40, 30, 0.25f, 0.5f, 0.125f);
  const Image test = solid(40, 30, 0.25f + offset, 0.5f - offset, 0.125f + offset);
  const ImageDifference difference = differenceOf(test, reference);
  CHECK(difference.rmseRgb == offset);
  CHECK(difference.rmse == std::sqrt(3.0 * offset * offset / 4));
  CHECK(difference.maxError == offset);
  CHECK(difference.p999 == offset);
  const auto relative = [&](double b) { return offset * offset / (b * b + 0.01); };
  CHECK(difference.relMse == Approx((relative(0.25) + relative(0.5) + relative(0.125)) / 3));
}

TEST_CASE("Alpha counts in RMSE, maximum and percentile, and not where only colour does", "[image]") {
  const ImageDifference difference =
      differenceOf(solid(12, 12, 0.25f, 0.25f, 0.25f, 0.75f), solid(12, 12, 0.25f, 0.25f, 0.25f));
  CHECK(difference.rmse == 0.125);  // sqrt(0.25^2 / 4)
  CHECK(difference.maxError == 0.25);
  CHECK(difference.p999 == 0.25);
  CHECK(difference.rmseRgb == 0);
  CHECK(difference.relMse == 0);
  CHECK(difference.flip == 0);  // in front of black
  DifferenceOptions white;
  white.background = glm::dvec3(1);
  CHECK(differenceOf(solid(12, 12, 0.25f, 0.25f, 0.25f, 0.75f), solid(12, 12, 0.25f, 0.25f, 0.25f), white).flip > 0.1);
}

TEST_CASE("The 99.9th percentile is the smallest error that 99.9 % do not exceed", "[image]") {
  const auto p999 = [](int width, int height) {
    return differenceOf(everyErrorUpTo(width, height), Image(width, height, 1)).p999;
  };
  CHECK(p999(100, 100) == 9990);
  CHECK(p999(1, 1) == 1);
  CHECK(p999(37, 27) == 999);
  CHECK(p999(50, 20) == 999);   // one of a thousand may be larger
  CHECK(p999(77, 26) == 2000);  // of 2002 two may be larger
}

TEST_CASE("The largest error is found, and the first of several", "[image]") {
  Image test(31, 17, 4);
  test.at(20, 5)[2] = 3;
  test.at(4, 9)[0] = -3;
  const ImageDifference difference = differenceOf(test, Image(31, 17, 4));
  CHECK(difference.maxError == 3);
  CHECK(difference.maxPixel == glm::ivec2(20, 5));
}

TEST_CASE("Errors scale with the images, and relative errors hardly change where the reference is bright", "[image]") {
  const Image a = formulaPicture(Formula::shifted), b = formulaPicture(Formula::smooth);
  const ImageDifference one = differenceOf(a, b), four = differenceOf(scaled(a, 4), scaled(b, 4));
  CHECK(four.rmse == 4 * one.rmse);  // a power of two rounds nowhere
  CHECK(four.rmseRgb == 4 * *one.rmseRgb);
  CHECK(four.maxError == 4 * one.maxError);
  CHECK(four.p999 == 4 * one.p999);
  const ImageDifference bright = differenceOf(scaled(a, 4096), scaled(b, 4096)),
                        brighter = differenceOf(scaled(a, 8192), scaled(b, 8192));
  CHECK(brighter.relMse == Approx(bright.relMse).epsilon(1e-6));  // b > 0.1 * 4096 beside 0.01
}

TEST_CASE("relMSE has its steady value where the reference is black", "[image]") {
  CHECK(differenceOf(row({0.5f, 0}), row({0, 0})).relMse == Approx(0.5 * 0.25 / 0.01));
  CHECK(differenceOf(row({0, 0}), row({0.5f, 0})).relMse == Approx(0.5 * 0.25 / 0.26));
}

TEST_CASE("Only for relMSE it matters which image is the reference", "[image]") {
  const Image a = formulaPicture(Formula::noise), b = formulaPicture(Formula::smooth);
  const ImageDifference there = differenceOf(a, b), back = differenceOf(b, a);
  CHECK(there.rmse == back.rmse);
  CHECK(there.maxError == back.maxError);
  CHECK(there.p999 == back.p999);
  CHECK(there.ssim == back.ssim);
  CHECK(there.flip == back.flip);
  CHECK(there.relMse != back.relMse);
}

TEST_CASE("The number of threads changes no bit", "[image]") {
  const Image a = formulaPicture(Formula::noise), b = formulaPicture(Formula::smooth);
  const ImageDifference all = differenceOf(a, b);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const ImageDifference single = differenceOf(a, b);
  CHECK(single.rmse == all.rmse);
  CHECK(single.relMse == all.relMse);
  CHECK(single.ssim == all.ssim);
  CHECK(single.flip == all.flip);
}

TEST_CASE("The same infinity or NaN in both images is equal", "[image]") {
  const Image depth = row({1, kInfinity, kNan, -kInfinity});
  const ImageDifference difference = differenceOf(depth, depth);
  CHECK(difference.rmse == 0);
  CHECK(difference.maxError == 0);
  CHECK(difference.relMse == 0);
  CHECK(difference.nonFiniteEqual == 3);
  CHECK(difference.nonFiniteDiffering == 0);
  CHECK(differenceOf(row({1, kInfinity}), row({4, kInfinity})).rmse == std::sqrt(4.5));
}

TEST_CASE("A value that is finite in one image only is never averaged away", "[image]") {
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    CAPTURE(bad);
    for (const bool inTest : {true, false}) {
      Image image = formulaPicture(Formula::smooth), broken = image;
      broken.at(7, 9)[1] = bad;
      const ImageDifference difference = inTest ? differenceOf(broken, image) : differenceOf(image, broken);
      CHECK(std::isinf(difference.rmse));
      CHECK(std::isinf(*difference.rmseRgb));
      CHECK(std::isinf(difference.maxError));
      CHECK(std::isinf(difference.relMse));
      CHECK(difference.maxPixel == glm::ivec2(7, 9));
      CHECK(difference.nonFiniteDiffering == 1);
      CHECK(difference.p999 == 0);  // one pixel of 3072
      CHECK(std::isfinite(*difference.ssim));
      CHECK(std::isfinite(*difference.flip));
    }
  }
  CHECK(std::isinf(differenceOf(row({kInfinity}), row({-kInfinity})).maxError));
  CHECK(std::isinf(differenceOf(row({kInfinity}), row({kNan})).p999));
  // Differences of finite floats do not overflow.
  const float most = std::numeric_limits<float>::max();
  CHECK(differenceOf(row({most}), row({-most})).rmse == 2.0 * most);
}

TEST_CASE("Images without colour, or smaller than a window, have no SSIM or FLIP", "[image]") {
  const ImageDifference single = differenceOf(Image(20, 20, 1), Image(20, 20, 1));
  CHECK(!single.rmseRgb);
  CHECK(!single.ssim);
  CHECK(!single.flip);
  const ImageDifference small = differenceOf(Image(20, 10, 4), Image(20, 10, 4));
  CHECK(!small.ssim);
  CHECK(small.flip == 0);
  CHECK(differenceOf(Image(11, 11, 3), Image(11, 11, 3)).ssim);
}

TEST_CASE("The error map holds the largest error of each pixel's channels", "[image]") {
  Image test(2, 2, 4), reference(2, 2, 4);
  test.at(1, 0)[0] = 0.25f;
  test.at(1, 0)[3] = -0.5f;
  reference.at(0, 1)[1] = 0.125f;
  test.at(1, 1)[2] = kNan;
  const Image map = errorMap(test, reference);
  CHECK(map.channels == 1);
  CHECK(map.pixels == std::vector<float>{0, 0.5f, 0.125f, kInfinity});
}

TEST_CASE("The signed difference keeps its sign, and 0 where both hold the same infinity", "[image]") {
  const Image difference = signedDifference(row({1, 3, kInfinity, kNan, kInfinity}), row({2, 1, kInfinity, kNan, 5}));
  CHECK(difference.pixels == std::vector<float>{-1, 2, 0, 0, kInfinity});
}

TEST_CASE("Images that cannot be compared are refused", "[image]") {
  CHECK_THROWS_WITH(differenceOf(Image(4, 3, 4), Image(3, 4, 4)), Contains("4 x 3 beside 3 x 4 pixels"));
  CHECK_THROWS_WITH(differenceOf(Image(4, 3, 4), Image(4, 3, 1)), Contains("4 beside 1 channels"));
  CHECK_THROWS_WITH(differenceOf(Image(), Image()), Contains("0 x 0"));
  CHECK_THROWS_AS(errorMap(Image(4, 3, 4), Image(3, 4, 4)), InvalidArgument);
  CHECK_THROWS_AS(signedDifference(Image(4, 3, 4), Image(4, 3, 1)), InvalidArgument);
  DifferenceOptions options;
  options.pixelsPerDegree = 0;
  CHECK_THROWS_WITH(differenceOf(Image(4, 3, 4), Image(4, 3, 4), options), Contains("pixels per degree"));
}
