// Gradients of voxels in double precision: see umbrick/optics/gradient_filter.h.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>

#include "umbrick/optics/gradient_filter.h"

namespace umbrick {

/// Returns the uniform cubic B-spline around a knot. @param x  distance from it, in knots
inline double cubicSpline(double x) {
  const double far = std::abs(x);
  if (far >= 2) return 0;
  return far < 1 ? 2.0 / 3 - far * far * (1 - far / 2) : std::pow(2 - far, 3) / 6;
}
inline double cubicSplineSlope(double x) {
  const double far = std::abs(x);
  if (far >= 2) return 0;
  return far < 1 ? x * (1.5 * far - 2) : std::copysign(std::pow(2 - far, 2) / 2, -x);
}

/// Returns the gradient per voxel at a place from a voxel. @param share  of a voxel, in [0, 1)
/// @param valueAt  of (i, j, k), whole voxels from there, from -1 to 2, and to 1 along an axis where the share is 0
template <class ValueAt>
glm::dvec3 voxelGradient(const glm::dvec3& share, GradientFilter filter, const ValueAt& valueAt) {
  const bool spline = filter == GradientFilter::bspline;
  // Linear interpolation of central differences is a spline of degree 1 along all axes but one.
  const auto weight = [&](double x) { return spline ? cubicSpline(x) : std::max(0.0, 1 - std::abs(x)); };
  const auto slope = [&](double x) { return spline ? cubicSplineSlope(x) : (weight(x + 1) - weight(x - 1)) / 2; };
  const double here = valueAt(0, 0, 0);  // where all is alike, the gradient is 0 to the last bit
  glm::dvec3 sum(0);
  for (int k = -1; k <= 2; ++k)
    for (int j = -1; j <= 2; ++j)
      for (int i = -1; i <= 2; ++i) {
        const glm::dvec3 from = share - glm::dvec3(i, j, k);
        const glm::dvec3 w(weight(from.x), weight(from.y), weight(from.z));
        const glm::dvec3 factor(slope(from.x) * w.y * w.z, w.x * slope(from.y) * w.z, w.x * w.y * slope(from.z));
        if (factor != glm::dvec3(0)) sum += factor * (valueAt(i, j, k) - here);
      }
  return sum;
}

}  // namespace umbrick
