// What a display shows of radiance: exposure, tone curves, the backdrop.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/display.h"

#include <catch2/catch.hpp>
#include <limits>
#include <vector>

#include "umbrick/core/error.h"
#include "umbrick/core/srgb.h"

using namespace umbrick;

namespace {

const std::vector<ToneMap> kAll{ToneMap::none, ToneMap::reinhard, ToneMap::filmic};

Image onePixel(float r, float g, float b, float a) {
  Image image(1, 1, 4);
  image.pixels = {r, g, b, a};
  return image;
}

}  // namespace

TEST_CASE("Every tone curve takes 0 to 0 and rises, and none is the identity", "[image]") {
  for (const ToneMap curve : kAll) {
    INFO(nameOf(kToneMaps, curve));
    CHECK(toneMapped(glm::dvec3(0), curve) == glm::dvec3(0));
    double before = 0;
    for (double x = 1e-4; x < 1e4; x *= 1.3) {
      const double y = toneMapped(glm::dvec3(x), curve).g;
      CHECK(y > before);
      before = y;
    }
  }
  CHECK(toneMapped({0.3, 7, 0.01}, ToneMap::none) == glm::dvec3(0.3, 7, 0.01));
}

// The values of the published formulas: 0.8 of 1.0, and at the limit 2.51 / 2.43; Reinhard's half of 1.
TEST_CASE("Tone curves have the values of their sources", "[image]") {
  CHECK(toneMapped(glm::dvec3(1), ToneMap::filmic).r == Approx(2.54 / 3.16));
  CHECK(toneMapped(glm::dvec3(1e9), ToneMap::filmic).r == Approx(2.51 / 2.43).epsilon(1e-6));
  CHECK(toneMapped(glm::dvec3(0.18), ToneMap::filmic).r == Approx(0.0867240 / 0.3249320).epsilon(1e-6));
  CHECK(toneMapped(glm::dvec3(1), ToneMap::reinhard).r == Approx(0.5));
  // It acts on the luminance, so that hues keep their ratio.
  const glm::dvec3 red = toneMapped({2, 1, 0}, ToneMap::reinhard);
  CHECK(red.r == Approx(2 * red.g));
  CHECK(red.g == Approx(1 / (1 + 2 * 0.2126 + 0.7152)));
}

TEST_CASE("An exposure of one stop doubles, and of minus one halves", "[image]") {
  CHECK(exposureFactor(0) == 1);
  CHECK(exposureFactor(1) == 2);
  CHECK(exposureFactor(-1) == 0.5);
  const Image image = onePixel(0.1f, 0.2f, 0.05f, 0.5f);
  const Image more = displayed(image, {.exposure = 1});
  for (std::size_t c = 0; c < 3; ++c) CHECK(more.pixels[c] == Approx(2 * image.pixels[c]));
  CHECK(more.pixels[3] == image.pixels[3]);
  // Colour over its own alpha is cut off at 1.
  CHECK(displayed(image, {.exposure = 3}).pixels[1] == Approx(0.5));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 101.0})
    CHECK_THROWS_AS(displayed(image, {.exposure = bad}), InvalidArgument);
  CHECK_THROWS_AS(displayed(Image(2, 2, 1), {}), InvalidArgument);
}

TEST_CASE("A tone curve acts on the colour over its own alpha", "[image]") {
  const Image shown = displayed(onePixel(0.5f, 0.25f, 0, 0.5f), {.toneMap = ToneMap::filmic});
  CHECK(shown.pixels[0] == Approx(0.5 * toneMapped(glm::dvec3(1), ToneMap::filmic).r));
  CHECK(shown.pixels[1] == Approx(0.5 * toneMapped(glm::dvec3(0.5), ToneMap::filmic).r));
  CHECK(shown.pixels[2] == 0);
  CHECK(shown.pixels[3] == 0.5f);
  // Without alpha there is no colour; NaN counts as 0.
  const Image none = displayed(onePixel(3, 3, 3, 0), {});
  CHECK(none.pixels == std::vector<float>{0, 0, 0, 0});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(displayed(onePixel(nan, 0.5f, 0, 1), {}).pixels == std::vector<float>{0, 0.5f, 0, 1});
}

TEST_CASE("The backdrop stands behind what is transparent, whatever the exposure", "[image]") {
  Image image(1, 8, 4);
  for (int y = 0; y < 8; ++y) {
    const float alpha = static_cast<float>(y) / 7;
    float* p = image.at(0, y);
    for (int c = 0; c < 3; ++c) p[c] = 0.3f * alpha;
    p[3] = alpha;
  }
  for (const double exposure : {0.0, 1.0}) {
    const Look look{.exposure = exposure, .backdrop = Backdrop::gradient};
    const Image shown = displayed(image, look);
    for (int y = 0; y < 8; ++y) {
      const double alpha = y / 7.0;
      const glm::dvec3 behind = gradientBackdrop((y + 0.5) / 8), before = displayed(glm::dvec3(0.3), look);
      for (int c = 0; c < 3; ++c)
        CHECK(shown.at(0, y)[c] == Approx(alpha * before[c] + (1 - alpha) * behind[c]).margin(1e-6));
      CHECK(shown.at(0, y)[3] == 1);
    }
  }
  // It is dark above and light below, in even steps of what is displayed.
  const double low = linearToSrgb(gradientBackdrop(0).g), middle = linearToSrgb(gradientBackdrop(0.5).g),
               high = linearToSrgb(gradientBackdrop(1).g);
  CHECK(low > 0.5);
  CHECK(high < 0.25);
  CHECK(middle == Approx(0.5 * (low + high)));
}
