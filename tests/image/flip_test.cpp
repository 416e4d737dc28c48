// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/flip.h"

#include <algorithm>
#include <array>
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

double meanOf(const Image& map) {
  return std::accumulate(map.pixels.begin(), map.pixels.end(), 0.0) / static_cast<double>(map.pixels.size());
}

Image randomPicture(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  Image image(width, height, 4);
  for (float& value : image.pixels) value = uniform(random);
  return image;
}

}  // namespace

// The numbers were computed with the authors' Python program (NVlabs/flip, python/flip_api.py, "compute_ldrflip"),
// carried over to double precision with SciPy's correlate for its 2D filters, on these pictures encoded as sRGB.
TEST_CASE("FLIP has the values of its authors' program", "[image]") {
  struct Expected {
    Formula test, reference;
    double pixelsPerDegree, mean, most, inside, corner;  // inside: at (20, 30)
  };
  const double ppd = kFlipPixelsPerDegree;
  const std::array<Expected, 8> all{{
      {Formula::shifted, Formula::smooth, ppd, 0.353152257739, 0.526196634872, 0.286428836846, 0.255504789467},
      {Formula::shifted, Formula::smooth, 20, 0.338004166160, 0.522622431493, 0.258960826609, 0.264726734580},
      {Formula::waves, Formula::checks, ppd, 0.669555817341, 0.976071952989, 0.398959578833, 0.966605569375},
      {Formula::waves, Formula::checks, 20, 0.933926844255, 0.979745527927, 0.773266083283, 0.959299046742},
      {Formula::noise, Formula::flat, ppd, 0.832501151860, 0.975381421458, 0.937776734308, 0.975381421458},
      {Formula::noise, Formula::flat, 20, 0.904682703721, 0.982081149976, 0.959063477864, 0.981287765074},
      {Formula::noise, Formula::smooth, ppd, 0.824870511610, 0.976965690509, 0.869511288643, 0.971317225594},
      {Formula::noise, Formula::smooth, 20, 0.887382185076, 0.990095335952, 0.828832760625, 0.979357447716},
  }};
  for (const Expected& expected : all) {
    CAPTURE(static_cast<int>(expected.test), expected.pixelsPerDegree);
    const Image map = flipMap(formulaPicture(expected.test), formulaPicture(expected.reference), glm::dvec3(0),
                              expected.pixelsPerDegree);
    const double tolerance = 1e-7;  // a map is of floats: 3e-8, and the authors' constants have nine digits
    CHECK(meanOf(map) == Approx(expected.mean).margin(tolerance));
    CHECK(*std::max_element(map.pixels.begin(), map.pixels.end()) == Approx(expected.most).margin(tolerance));
    CHECK(map.at(20, 30)[0] == Approx(expected.inside).margin(tolerance));
    CHECK(map.at(0, 0)[0] == Approx(expected.corner).margin(tolerance));
  }
}

TEST_CASE("FLIP of a picture and itself is 0, and neither order nor direction matters", "[image]") {
  const Image a = formulaPicture(Formula::noise), b = formulaPicture(Formula::smooth);
  const Image same = flipMap(a, a);
  CHECK(std::all_of(same.pixels.begin(), same.pixels.end(), [](float value) { return value == 0; }));
  const Image map = flipMap(a, b);
  CHECK(map.channels == 1);
  CHECK(flipMap(b, a).pixels == map.pixels);
  const auto mirrored = [](const Image& image) {
    Image out(image.width, image.height, image.channels);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) std::copy_n(image.at(x, y), image.channels, out.at(image.width - 1 - x, y));
    return out;
  };
  const Image back = mirrored(flipMap(mirrored(a), mirrored(b)));
  for (std::size_t i = 0; i < map.pixels.size(); ++i)  // the sums of the filters run the other way
    CHECK(back.pixels[i] == Approx(map.pixels[i]).margin(1e-6));
}

// By definition the scale ends at the distance of green to blue.
TEST_CASE("FLIP is in [0, 1], and green beside blue is 1", "[image]") {
  const auto flip = [](const glm::vec3& a, const glm::vec3& b) {
    return flipMap(solid(1, 1, a.r, a.g, a.b), solid(1, 1, b.r, b.g, b.b)).pixels[0];
  };
  CHECK(flip({0, 1, 0}, {0, 0, 1}) == 1);
  const auto colour = [](int i) { return glm::vec3(i % 3, i / 3 % 3, i / 9) / 2.0f; };
  for (int i = 0; i < 27; ++i)
    for (int j = 0; j < i; ++j) {
      CHECK(flip(colour(i), colour(j)) > 0);
      CHECK(flip(colour(i), colour(j)) <= 1);
    }
  for (const double pixelsPerDegree : {1.0, 67.0, 1000.0}) {
    const Image map = flipMap(randomPicture(30, 20, 1), randomPicture(30, 20, 2), glm::dvec3(0.5), pixelsPerDegree);
    for (const float value : map.pixels) CHECK((value >= 0 && value <= 1));
  }
}

// Without features FLIP is the distance of two colours: CIELAB of the primaries as tabulated (sRGB, D65), with Hunt's
// factor L / 100, and HyAB. A grey c has L = 116 cbrt(c) - 16. The white of the table differs in the fourth digit
// from the paper's.
TEST_CASE("FLIP of two greys has its closed form", "[image]") {
  const double green = 0.877347, blue = 0.322970;
  const double largest = std::pow(
      87.7347 - 32.2970 + std::hypot(green * -86.1827 - blue * 79.1875, green * 83.1793 + blue * 107.8602), 0.7);
  const auto flip = [](float a, float b) { return flipMap(solid(5, 4, a, a, a), solid(5, 4, b, b, b)).at(2, 1)[0]; };
  const auto lightness = [](double c) { return 116 * std::cbrt(c) - 16; };
  const double step = std::pow(lightness(0.5) - lightness(0.25), 0.7);
  CHECK(flip(0.5f, 0.25f) == Approx(0.95 * step / (0.4 * largest)).epsilon(1e-3));
  const double most = std::pow(100, 0.7);
  CHECK(flip(1, 0) == Approx(0.95 + 0.05 * (most - 0.4 * largest) / (0.6 * largest)).epsilon(1e-3));
}

TEST_CASE("Fine detail differs less to FLIP the farther away it is seen", "[image]") {
  Image detail(40, 40, 4);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x)
      std::copy_n(solid(1, 1, (x + y) % 2, (x + y) % 2, (x + y) % 2).at(0, 0), 4, detail.at(x, y));
  const Image grey = solid(40, 40, 0.5f, 0.5f, 0.5f);
  double before = 1;
  for (const double pixelsPerDegree : {10.0, 20.0, 40.0, 80.0}) {
    const double flip = meanOf(flipMap(detail, grey, glm::dvec3(0), pixelsPerDegree));
    CHECK(flip < before);
    before = flip;
  }
  CHECK(before < 0.01);  // finer than the eye resolves
}

TEST_CASE("FLIP compares what a screen shows", "[image]") {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const auto flip = [](const Image& a, const Image& b, const glm::dvec3& background = glm::dvec3(0)) {
    return flipMap(a, b, background).pixels[0];
  };
  CHECK(flip(solid(3, 3, 0, 0, 0, 0), solid(3, 3, 1, 1, 1), glm::dvec3(1)) == 0);
  CHECK(flip(solid(3, 3, 0.25f, 0, 0, 0.5f), solid(3, 3, 0.5f, 0.25f, 0.25f), glm::dvec3(0.5)) == 0);
  CHECK(flip(solid(3, 3, 0.25f, 0, 0, 0.5f), solid(3, 3, 0.25f, 0, 0)) == 0);
  CHECK(flip(solid(3, 3, 7, -1, infinity), solid(3, 3, 1, 0, 1)) == 0);
  CHECK(flip(solid(3, 3, nan, 0, 0), solid(3, 3, 0, 0, 0)) == 0);
  Image three(3, 3, 3), black(3, 3, 3);
  std::fill(three.pixels.begin(), three.pixels.end(), 1.0f);
  CHECK(flip(three, black) == flip(solid(3, 3, 1, 1, 1), solid(3, 3, 0, 0, 0)));
}

TEST_CASE("FLIP refuses pictures that it cannot compare, and options out of range", "[image]") {
  const Image a(4, 3, 4);
  CHECK_THROWS_WITH(flipMap(a, Image(3, 4, 4)), Contains("4 x 3 beside 3 x 4 pixels"));
  CHECK_THROWS_WITH(flipMap(a, Image(4, 3, 3)), Contains("4 beside 3 channels"));
  CHECK_THROWS_WITH(flipMap(Image(4, 3, 1), Image(4, 3, 1)), Contains("expected 3 or 4 channels, found 1"));
  CHECK_THROWS_WITH(flipMap(Image(), Image()), Contains("0 x 0"));
  CHECK_THROWS_WITH(flipMap(a, a, glm::dvec3(0, 2, 0)), Contains("background"));
  for (const double pixelsPerDegree : {0.5, 1001.0, std::nan("")})
    CHECK_THROWS_WITH(flipMap(a, a, glm::dvec3(0), pixelsPerDegree), Contains("pixels per degree"));
}
