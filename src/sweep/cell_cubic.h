// The value along a ray within one cell of voxels, which is a polynomial of degree three.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/vec3.hpp>

namespace umbrick {

/// The values at the corners of a cell, x fastest.
using CellCorners = std::array<double, 8>;

/// The polynomial c[0] + c[1] s + c[2] s^2 + c[3] s^3 for s in [0, 1].
struct CellCubic {
  std::array<double, 4> c{};
  double operator()(double s) const { return c[0] + s * (c[1] + s * (c[2] + s * c[3])); }
};

/// Returns the trilinear value along the line between two points of the cell [0, 1]^3.
CellCubic cubicBetween(const CellCorners& corners, const glm::dvec3& from, const glm::dvec3& to);

/// The places where a cubic crosses a value.
struct CellCrossings {
  int count = 0;
  std::array<double, 3> places{};  // ascending
  bool above = false;              // whether the value at s = 1 counts as above
};

/// Finds all crossings in [0, 1], to 1e-12 of the way: the cubic is cut where it turns, and a bracket that Newton's
/// steps may not leave shrinks around the crossing of each part.
/// @param above  whether the ray comes from above the value: rounding at the face between two cells loses no crossing
CellCrossings crossingsOf(const CellCubic& cubic, double value, bool above);

}  // namespace umbrick
