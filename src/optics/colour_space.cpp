// SPDX-License-Identifier: Apache-2.0
#include "optics/colour_space.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>

#include "umbrick/core/srgb.h"

namespace umbrick {
namespace {
constexpr double kWhite[3] = {0.9505, 1.0, 1.0890};  // XYZ of D65 as VTK has it

glm::dvec3 mix(const glm::dvec3& a, const glm::dvec3& b, double t) { return a + (b - a) * t; }

glm::dvec3 toLab(const glm::dvec3& display) {
  const double r = srgbToLinear(display.r), g = srgbToLinear(display.g), b = srgbToLinear(display.b);
  const double xyz[3] = {0.4124 * r + 0.3576 * g + 0.1805 * b, 0.2126 * r + 0.7152 * g + 0.0722 * b,
                         0.0193 * r + 0.1192 * g + 0.9505 * b};
  double f[3];
  for (int i = 0; i < 3; ++i) {
    const double share = xyz[i] / kWhite[i];
    f[i] = share > 0.008856 ? std::cbrt(share) : 7.787 * share + 16.0 / 116;
  }
  return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

glm::dvec3 fromLab(const glm::dvec3& lab) {
  const double fy = (lab.x + 16) / 116;
  const double f[3] = {fy + lab.y / 500, fy, fy - lab.z / 200};
  double xyz[3];
  for (int i = 0; i < 3; ++i) {
    const double cube = f[i] * f[i] * f[i];
    xyz[i] = kWhite[i] * (cube > 0.008856 ? cube : (f[i] - 16.0 / 116) / 7.787);
  }
  const glm::dvec3 linear{3.2406 * xyz[0] - 1.5372 * xyz[1] - 0.4986 * xyz[2],
                          -0.9689 * xyz[0] + 1.8758 * xyz[1] + 0.0415 * xyz[2],
                          0.0557 * xyz[0] - 0.2040 * xyz[1] + 1.0570 * xyz[2]};
  return {linearToSrgb(linear.r), linearToSrgb(linear.g), linearToSrgb(linear.b)};
}

glm::dvec3 toHsv(const glm::dvec3& c) {
  const double high = std::max({c.r, c.g, c.b}), chroma = high - std::min({c.r, c.g, c.b});
  double hue = 0;  // in turns
  if (chroma > 0) {
    if (high == c.r) {
      hue = (c.g - c.b) / chroma / 6;
    } else {
      hue = high == c.g ? (2 + (c.b - c.r) / chroma) / 6 : (4 + (c.r - c.g) / chroma) / 6;
    }
    if (hue < 0) hue += 1;
  }
  return {hue, high > 0 ? chroma / high : 0, high};
}

glm::dvec3 fromHsv(const glm::dvec3& hsv) {
  const double hue = (hsv.x - std::floor(hsv.x)) * 6;
  const glm::dvec3 full =
      glm::clamp(glm::dvec3(std::abs(hue - 3) - 1, 2 - std::abs(hue - 2), 2 - std::abs(hue - 4)), 0.0, 1.0);
  return hsv.z * mix(glm::dvec3(1), full, hsv.y);
}

// Returns a Lab colour as Msh: magnitude, saturation angle and hue angle.
glm::dvec3 toMsh(const glm::dvec3& lab) {
  const double magnitude = std::sqrt(lab.x * lab.x + lab.y * lab.y + lab.z * lab.z);
  const double saturation = magnitude > 0.001 ? std::acos(std::clamp(lab.x / magnitude, -1.0, 1.0)) : 0;
  return {magnitude, saturation, saturation > 0.001 ? std::atan2(lab.z, lab.y) : 0};
}

glm::dvec3 fromMsh(const glm::dvec3& msh) {
  return {msh.x * std::cos(msh.y), msh.x * std::sin(msh.y) * std::cos(msh.z),
          msh.x * std::sin(msh.y) * std::sin(msh.z)};
}

// Returns the hue with which a saturated colour meets an unsaturated one of magnitude `unsaturated`.
double adjustedHue(const glm::dvec3& msh, double unsaturated) {
  if (msh.x >= unsaturated - 0.1) return msh.z;
  const double spin = msh.y * std::sqrt(unsaturated * unsaturated - msh.x * msh.x) / (msh.x * std::sin(msh.y));
  return msh.z > -std::numbers::pi / 3 ? msh.z + spin : msh.z - spin;
}

glm::dvec3 mixDiverging(const glm::dvec3& from, const glm::dvec3& to, double t) {
  glm::dvec3 a = toMsh(toLab(from)), b = toMsh(toLab(to));
  double turn = std::abs(a.z - b.z);
  if (turn > std::numbers::pi) turn = 2 * std::numbers::pi - turn;
  if (a.y > 0.05 && b.y > 0.05 && turn > std::numbers::pi / 3) {
    const glm::dvec3 white{std::max({a.x, b.x, 88.0}), 0, 0};
    if (t < 0.5) {
      b = white;
      t = 2 * t;
    } else {
      a = white;
      t = 2 * t - 1;
    }
  }
  if (a.y < 0.05 && b.y > 0.05) a.z = adjustedHue(b, a.x);
  if (b.y < 0.05 && a.y > 0.05) b.z = adjustedHue(a, b.x);
  return fromLab(fromMsh(mix(a, b, t)));
}

glm::dvec3 mixHsv(const glm::dvec3& from, const glm::dvec3& to, double t, bool wrap) {
  glm::dvec3 a = toHsv(from), b = toHsv(to);
  if (wrap && std::abs(a.x - b.x) > 0.5) (a.x < b.x ? a : b).x += 1;
  return fromHsv(mix(a, b, t));
}

}  // namespace

glm::dvec3 mixColours(const glm::dvec3& from, const glm::dvec3& to, double t, ColourSpace space) {
  if (space == ColourSpace::step) return to;
  // The way into a colour space and back is rounded, but the ends must be exact.
  if (t <= 0) return from;
  if (t >= 1) return to;
  glm::dvec3 colour = mix(from, to, t);
  switch (space) {
    case ColourSpace::rgb:
      break;
    case ColourSpace::hsv:
      colour = mixHsv(from, to, t, false);
      break;
    case ColourSpace::hsvWrap:
      colour = mixHsv(from, to, t, true);
      break;
    case ColourSpace::lab:
      colour = fromLab(mix(toLab(from), toLab(to), t));
      break;
    case ColourSpace::diverging:
      colour = mixDiverging(from, to, t);
      break;
    case ColourSpace::step:
      break;
  }
  return glm::clamp(colour, 0.0, 1.0);
}

}  // namespace umbrick
