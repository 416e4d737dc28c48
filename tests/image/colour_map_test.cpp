// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/colour_map.h"

#include <array>
#include <catch2/catch.hpp>
#include <limits>
#include <utility>

#include "umbrick/core/error.h"
#include "umbrick/core/srgb.h"

using namespace umbrick;
using Catch::Contains;

// The colours of the published table here lie between those that are stored.
TEST_CASE("Magma is the published map to 2.2 of 255", "[image]") {
  const std::array<std::pair<int, glm::dvec3>, 6> published{{{0, {0.001462, 0.000466, 0.013866}},
                                                             {25, {0.078815, 0.054184, 0.211667}},
                                                             {64, {0.316654, 0.07169, 0.48538}},
                                                             {128, {0.716387, 0.214982, 0.47529}},
                                                             {200, {0.992785, 0.594891, 0.410283}},
                                                             {255, {0.987053, 0.991438, 0.749504}}}};
  for (const auto& [index, colour] : published)
    for (int c = 0; c < 3; ++c) CHECK(magma(index / 255.0)[c] == Approx(colour[c]).margin(2.2 / 255));
}

TEST_CASE("Magma gets brighter from end to end", "[image]") {
  double before = -1;
  for (int i = 0; i <= 1000; ++i) {
    const glm::dvec3 colour = magma(i / 1000.0);
    double luminance = 0;
    for (int c = 0; c < 3; ++c) luminance += std::array{0.2126, 0.7152, 0.0722}[c] * srgbToLinear(colour[c]);
    CHECK(luminance > before);
    before = luminance;
  }
}

TEST_CASE("A colour-mapped image holds the map's colours, linear and opaque, and green for NaN", "[image]") {
  const float infinity = std::numeric_limits<float>::infinity();
  Image values(6, 1, 1);
  values.pixels = {-5, 2, 3, 4, infinity, std::numeric_limits<float>::quiet_NaN()};
  const Image image = colourMapped(values, 2, 4);
  REQUIRE(image.channels == 4);
  const std::array<glm::dvec3, 6> expected{magma(0), magma(0), magma(0.5), magma(1), magma(1), glm::dvec3(0, 1, 0)};
  for (int x = 0; x < 6; ++x) {
    for (int c = 0; c < 3; ++c)
      CHECK(linearToSrgb(image.at(x, 0)[c]) == Approx(expected[static_cast<std::size_t>(x)][c]).margin(1e-6));
    CHECK(image.at(x, 0)[3] == 1);
  }
}

TEST_CASE("Colour maps refuse an empty range", "[image]") {
  const Image values(2, 2, 1);
  CHECK_THROWS_WITH(colourMapped(Image(2, 2, 4), 0, 1), Contains("expected 1 channel, found 4"));
  CHECK_THROWS_WITH(colourMapped(values, 1, 1), Contains("expected a range of values"));
  CHECK_THROWS_AS(colourMapped(values, 0, std::numeric_limits<double>::infinity()), InvalidArgument);
}
