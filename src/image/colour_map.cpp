// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/colour_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

#include "umbrick/core/error.h"
#include "umbrick/core/srgb.h"

namespace umbrick {
namespace {

// Every 17th of the 256 colours of magma, in 8-bit sRGB. Smith and van der Walt 2015, "A Better Default Colormap
// for Matplotlib", https://bids.github.io/colormap; the data are CC0. Straight lines between these miss the others
// by 2.2 at most.
const std::array<glm::dvec3, 16> kMagma{{{0, 0, 4},
                                         {11, 9, 36},
                                         {32, 17, 75},
                                         {59, 15, 112},
                                         {87, 21, 126},
                                         {114, 31, 129},
                                         {140, 41, 129},
                                         {168, 50, 125},
                                         {196, 60, 117},
                                         {222, 73, 104},
                                         {241, 96, 93},
                                         {250, 127, 94},
                                         {254, 159, 109},
                                         {254, 191, 132},
                                         {253, 222, 160},
                                         {252, 253, 191}}};

}  // namespace

glm::dvec3 magma(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (kMagma.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(at), kMagma.size() - 2);
  return glm::mix(kMagma[below], kMagma[below + 1], at - static_cast<double>(below)) / 255.0;
}

Image colourMapped(const Image& values, double low, double high) {
  if (values.channels != 1)
    throw InvalidArgument("colour map: expected 1 channel, found " + std::to_string(values.channels));
  if (!(std::isfinite(low) && std::isfinite(high) && low < high))
    throw InvalidArgument("colour map: expected a range of values, found " + std::to_string(low) + " to " +
                          std::to_string(high));
  Image image(values.width, values.height, 4);
  float* out = image.pixels.data();
  for (const float value : values.pixels) {
    const glm::dvec3 shown = std::isnan(value) ? glm::dvec3(0, 1, 0) : magma((value - low) / (high - low));
    for (int c = 0; c < 3; ++c) *out++ = static_cast<float>(srgbToLinear(shown[c]));
    *out++ = 1;
  }
  return image;
}

}  // namespace umbrick
