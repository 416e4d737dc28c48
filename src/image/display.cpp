// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/display.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <string>

#include "image/finite.h"
#include "umbrick/core/error.h"
#include "umbrick/core/srgb.h"

namespace umbrick {
namespace {

const glm::dvec3 kBelow(0.60, 0.62, 0.65), kAbove(0.17, 0.19, 0.23);  // sRGB display values

}  // namespace

glm::dvec3 displayed(const glm::dvec3& radiance, const Look& look) {
  return glm::min(toneMapped(radiance * exposureFactor(look.exposure), look.toneMap), 1.0);
}

glm::dvec3 gradientBackdrop(double height) {
  const glm::dvec3 encoded = glm::mix(kBelow, kAbove, std::clamp(height, 0.0, 1.0));
  return {srgbToLinear(encoded.r), srgbToLinear(encoded.g), srgbToLinear(encoded.b)};
}

Image displayed(const Image& picture, const Look& look) {
  if (picture.channels != 4)
    throw InvalidArgument("display: expected 4 channels, found " + std::to_string(picture.channels));
  Image shown(picture.width, picture.height, 4);
  for (int y = 0; y < picture.height; ++y) {
    const glm::dvec3 behind =
        look.backdrop == Backdrop::gradient ? gradientBackdrop((y + 0.5) / picture.height) : glm::dvec3(0);
    for (int x = 0; x < picture.width; ++x) {
      const float* p = picture.at(x, y);
      const double alpha = std::min(1.0, finiteOr0(p[3]));
      glm::dvec3 colour(0);
      if (alpha > 0)
        colour = alpha * displayed(glm::dvec3(finiteOr0(p[0]), finiteOr0(p[1]), finiteOr0(p[2])) / alpha, look);
      colour += (1 - alpha) * behind;
      for (int c = 0; c < 3; ++c) shown.at(x, y)[c] = static_cast<float>(colour[c]);
      shown.at(x, y)[3] = look.backdrop == Backdrop::none ? static_cast<float>(alpha) : 1.0f;
    }
  }
  return shown;
}

}  // namespace umbrick
