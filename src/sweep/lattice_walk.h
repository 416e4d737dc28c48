// The way of a ray through the boxes of a lattice. Source: Amanatides and Woo 1987, doi:10.2312/egtp.19871000
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <limits>
#include <type_traits>

#include "sweep/value_ray.h"

namespace umbrick {

/// Calls visit(cell, enter, leave) for the boxes of a lattice that a ray meets, in order, until it returns false.
/// @param low      corner of the box 0 0 0
/// @param count    boxes along each axis
/// @param inverse  1 over the ray's direction
/// @return whether it never did
template <class Count, class Visit>
bool walkLattice(const glm::dvec3& low, const glm::dvec3& edge, const Count& count, const ValueRay& ray,
                 const glm::dvec3& inverse, double enter, double leave, const Visit& visit) {
  const glm::dvec3 start = (ray.at(enter) - low) / edge;
  Count cell, step(0);
  glm::dvec3 next(std::numeric_limits<double>::infinity()), width(0);
  for (int axis = 0; axis < 3; ++axis) {
    using Number = std::decay_t<decltype(cell[axis])>;
    cell[axis] = static_cast<Number>(std::clamp(std::floor(start[axis]), 0.0, static_cast<double>(count[axis] - 1)));
    const double along = ray.direction[axis];
    if (along == 0) continue;
    step[axis] = along > 0 ? 1 : -1;
    width[axis] = edge[axis] * std::abs(inverse[axis]);
    const double face = low[axis] + edge[axis] * static_cast<double>(cell[axis] + (along > 0 ? 1 : 0));
    next[axis] = (face - ray.origin[axis]) * inverse[axis];
  }
  for (double t = enter; t < leave;) {
    const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
    const double to = std::min(next[axis], leave);
    if (to > t) {
      if (!visit(cell, t, to)) return false;
      t = to;
    }
    cell[axis] += step[axis];
    if (cell[axis] < 0 || cell[axis] >= count[axis]) return true;
    next[axis] += width[axis];
  }
  return true;
}

}  // namespace umbrick
