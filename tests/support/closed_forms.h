// Media that have closed forms, and the integrals that they need.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <functional>
#include <numbers>

#include "support/test_grids.h"
#include "umbrick/optics/directions.h"
#include "umbrick/optics/transfer_function.h"

namespace umbrick {

/// A grid whose domain is exactly `domain`: active voxels lie one inside.
inline ScalarGrid fieldGrid(const IndexBox& domain, const std::function<double(const glm::dvec3&)>& value,
                            const glm::dmat4& indexToWorld = glm::dmat4(1), float background = 0) {
  const glm::ivec3 first = domain.min + 1, last = domain.max - 1;
  return withTransform(
      makeFilled(
          last - first + 1, first, [&](const glm::ivec3& p) { return value(glm::dvec3(first + p)); }, background),
      indexToWorld);
}

/// Nothing at negative values, a medium from 0 on.
inline TransferFunction solidAbove(const glm::dvec3& albedo, double sigma_t) {
  return TransferFunction({{0, {albedo, 0}}, {0, {albedo, sigma_t}}});
}

/// The share of the solid angle of a cone of half-angle `aperture` that lies beyond a plane through its apex, at the
/// angle `distance` in [0, pi/2) from its axis. By integration of 2 acos(tan distance / tan angle) sin angle.
inline double shareBeyond(double aperture, double distance) {
  if (distance >= aperture) return 0;
  const double part = aperture >= std::numbers::pi / 2 - 1e-12
                          ? 0
                          : std::cos(aperture) * std::acos(std::tan(distance) / std::tan(aperture));
  return 2 * (std::acos(std::sin(distance) / std::sin(aperture)) - part) /
         (2 * std::numbers::pi * (1 - std::cos(aperture)));
}

/// On a field that is its own z: one slab from z = 5.3 to 8.6, another from 13.1 to 17.45.
struct TwoSlabs {
  const glm::dvec3 a{1, 0.3, 0.1}, b{0.2, 0.6, 0.9};  // albedo of the lower and the upper one
  const TransferFunction transfer{{{5.3, {a, 0}},
                                   {5.3, {a, 0.4}},
                                   {8.6, {a, 0.4}},
                                   {8.6, {b, 0}},
                                   {13.1, {b, 0}},
                                   {13.1, {b, 0.15}},
                                   {17.45, {b, 0.15}},
                                   {17.45, {b, 0}}}};

  /// Through both. @param stretch  length of the ray per unit of z
  static double transmittance(double stretch) { return throughA(stretch) * throughB(stretch); }
  /// What they scatter. @param above  seen from large z
  glm::dvec3 light(double stretch, bool above) const {
    const glm::dvec3 slabA = (1 - throughA(stretch)) * a, slabB = (1 - throughB(stretch)) * b;
    return above ? slabB + throughB(stretch) * slabA : slabA + throughA(stretch) * slabB;
  }

 private:
  static double throughA(double stretch) { return std::exp(-0.4 * 3.3 * stretch); }
  static double throughB(double stretch) { return std::exp(-0.15 * 4.35 * stretch); }
};

/// Integral over [a, b] by Gauss-Legendre, for expected values that are integrals of smooth functions.
inline double integral(double a, double b, const std::function<double(double)>& f, int nodes = 64) {
  double sum = 0;
  for (const QuadratureNode& node : gaussLegendre(nodes)) sum += node.weight * f(a + node.position * (b - a));
  return (b - a) * sum;
}

}  // namespace umbrick
