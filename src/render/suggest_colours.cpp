// SPDX-License-Identifier: Apache-2.0
#include "render/suggest_colours.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "umbrick/core/srgb.h"

namespace umbrick {
namespace {

// Converts lightness, chroma and hue of Oklab to linear sRGB. Björn Ottosson 2020, "A perceptual color space for image
// processing". @param hue  degrees
glm::dvec3 fromOklch(double lightness, double chroma, double hue) {
  const double angle = hue * std::numbers::pi / 180, a = chroma * std::cos(angle), b = chroma * std::sin(angle);
  const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
  const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
  const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
  const glm::dvec3 linear(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
                          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s);
  return {std::clamp(linear.r, 0.0, 1.0), std::clamp(linear.g, 0.0, 1.0), std::clamp(linear.b, 0.0, 1.0)};
}

double between(double from, double to, double share) { return from + (to - from) * share; }

glm::dvec3 fromSrgb(int red, int green, int blue) {
  return {srgbToLinear(red / 255.0), srgbToLinear(green / 255.0), srgbToLinear(blue / 255.0)};
}

}  // namespace

glm::dvec3 ascendingColour(double share) {
  return fromOklch(between(0.68, 0.95, share), between(0.11, 0.08, share), between(245, 95, share));
}

glm::dvec3 plainColour() { return fromOklch(0.89, 0.035, 70); }

glm::dvec3 divergingColour(double share) {
  const double strength = std::abs(share);
  return fromOklch(between(0.95, 0.65, strength), between(0, 0.15, strength), share < 0 ? 255 : 30);
}

glm::dvec3 glowingColour(double share) {
  return fromOklch(between(0.52, 0.95, share), between(0.17, 0.09, share), between(27, 95, share));
}

glm::dvec3 labelColour(std::size_t label) {
  const glm::dvec3 okabeIto[]{fromSrgb(230, 159, 0),  fromSrgb(86, 180, 233), fromSrgb(0, 158, 115),
                              fromSrgb(240, 228, 66), fromSrgb(0, 114, 178),  fromSrgb(213, 94, 0),
                              fromSrgb(204, 121, 167)};
  if (label < std::size(okabeIto)) return okabeIto[label];
  constexpr double kGoldenAngle = 137.50776405;
  const double turn = std::fmod(kGoldenAngle * static_cast<double>(label), 360);
  return fromOklch(label % 2 == 0 ? 0.72 : 0.84, 0.11, turn);
}

}  // namespace umbrick
