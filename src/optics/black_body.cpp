// SPDX-License-Identifier: Apache-2.0
#include "umbrick/optics/black_body.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace umbrick {
namespace {

// A bell whose halves have widths of their own, nm.
double lobe(double nm, double centre, double below, double above) {
  const double x = (nm - centre) / (nm < centre ? below : above);
  return std::exp(-0.5 * x * x);
}

glm::dvec3 matchingFunctions(double nm) {
  return {
      1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) - 0.065 * lobe(nm, 501.1, 20.4, 26.2),
      0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
      1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)};
}

// Planck's law by wavelength, W / (m^2 sr nm).
double planck(double nm, double kelvin) {
  constexpr double kFirst = 1.191042972e-16, kSecond = 1.438776877e-2;  // 2 h c^2, W m^2 / sr, and h c / k, m K
  const double metres = nm * 1e-9;
  return 1e-9 * kFirst / (std::pow(metres, 5) * std::expm1(kSecond / (metres * kelvin)));
}

// The luminance of linear sRGB, IEC 61966-2-1.
constexpr glm::dvec3 kLuminance{0.2126729, 0.7151522, 0.0721750};

}  // namespace

glm::dvec3 blackBodyXyz(double kelvin) {
  glm::dvec3 sum(0);
  constexpr int kStep = 2;  // nm; the functions are smooth and end at 0, so that equal weights are exact to 1e-6
  for (int nm = 360; nm <= 830; nm += kStep) sum += kStep * planck(nm, kelvin) * matchingFunctions(nm);
  return sum;
}

glm::dvec3 blackBodyColour(double kelvin) {
  const glm::dvec3 xyz = blackBodyXyz(kelvin);
  const glm::dmat3 toRgb{{3.2404542, -0.9692660, 0.0556434},
                         {-1.5371385, 1.8760108, -0.2040259},
                         {-0.4985314, 0.0415560, 1.0572252}};  // by column; white is D65
  const glm::dvec3 inside = glm::max(toRgb * (xyz / xyz.y), glm::dvec3(0));
  return inside / glm::dot(inside, kLuminance);
}

}  // namespace umbrick
