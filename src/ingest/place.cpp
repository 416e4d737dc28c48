// SPDX-License-Identifier: Apache-2.0
#include "ingest/place.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <sstream>

#include "umbrick/core/error.h"

namespace umbrick {

bool spansSpace(const glm::dmat4& m) {
  double volume = 1;
  for (int axis = 0; axis < 3; ++axis) volume *= glm::length(glm::dvec3(m[axis]));
  // 1e-9: far below the sine of any angle between scanned axes, far above what rounding makes of two that coincide.
  return std::abs(glm::determinant(glm::dmat3(m))) > 1e-9 * volume;
}

void scaleWorld(glm::dmat4& indexToWorld, const glm::dvec3& factors) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) indexToWorld[column][row] *= factors[row];
}

void checkPlace(const VolumeInfo& info, const std::string& field) {
  const glm::dmat4& m = info.indexToWorld;
  bool finite = true;
  for (int axis = 0; axis < 4; ++axis)
    for (int row = 0; row < 3; ++row) finite = finite && std::isfinite(m[axis][row]);
  if (finite && spansSpace(m)) return;
  std::ostringstream text;
  text << info.name << ": " << field << ": expected finite numbers and three independent directions, found columns";
  for (int axis = 0; axis < 4; ++axis) text << " (" << m[axis].x << ' ' << m[axis].y << ' ' << m[axis].z << ')';
  throw IoError(text.str());
}

}  // namespace umbrick
