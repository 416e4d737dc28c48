// A line in continuous index space.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <limits>

namespace umbrick {

inline double largestComponent(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// The line origin + t direction, where t is a length in world units.
struct IndexRay {
  IndexRay() = default;
  IndexRay(const glm::dvec3& from, const glm::dvec3& along)
      : origin(from), direction(along), inverse(1.0 / along), perVoxel(1 / largestComponent(along)) {}

  glm::dvec3 origin{0}, direction{0};
  glm::dvec3 inverse{std::numeric_limits<double>::infinity()};  // of each component of the direction
  /// The t by which the coordinate that changes fastest changes by 1.
  double perVoxel = 0;

  glm::dvec3 at(double t) const { return origin + t * direction; }
};

/// The part of a ray from `begin` to `end`.
struct Interval {
  double begin = 0, end = 0;
  bool empty() const { return !(begin < end); }
};

/// Returns a step along the ray that is too short to matter for the field and yet leads off a face: 1e-7 voxels, or
/// more where coordinates are so large that double precision has no such step.
inline double nudgeOf(const IndexRay& ray, const glm::dvec3& at) {
  return std::max(1e-7, 0x1p-48 * largestComponent(at)) * ray.perVoxel;
}

/// Returns the t at which a ray leaves the box [low, high] that it is in.
inline double exitOf(const IndexRay& ray, const glm::dvec3& low, const glm::dvec3& high) {
  double exit = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double d = ray.direction[axis];
    if (d != 0) exit = std::min(exit, ((d > 0 ? high[axis] : low[axis]) - ray.origin[axis]) * ray.inverse[axis]);
  }
  return exit;
}

/// Returns the largest whole number that is not above x, which an int must hold.
inline int floorToInt(double x) {
  const int whole = static_cast<int>(x);
  return whole - (x < whole ? 1 : 0);
}

/// Calls visit(cell, begin, end) for the cells of a lattice of 8 x 8 x 8 cubes that the ray meets from `begin` to
/// `end`, in order, until it returns false. `origin` is the lowest corner of the lattice. Amanatides and Woo 1987.
/// @return false if visit returned false
template <class Visit>
bool walkLattice(const glm::dvec3& origin, double edge, const IndexRay& ray, double begin, double end,
                 const Visit& visit) {
  const glm::dvec3 at = ray.at(begin);
  const glm::dvec3 start = (at + nudgeOf(ray, at) * ray.direction - origin) * (1 / edge);
  glm::ivec3 cell, step(0);
  glm::dvec3 next(std::numeric_limits<double>::infinity()), width(0);
  for (int axis = 0; axis < 3; ++axis) {
    cell[axis] = std::clamp(floorToInt(start[axis]), 0, 7);
    const double d = ray.direction[axis];
    if (d == 0) continue;
    step[axis] = d > 0 ? 1 : -1;
    width[axis] = edge * std::abs(ray.inverse[axis]);
    next[axis] = (origin[axis] + edge * (cell[axis] + (d > 0)) - ray.origin[axis]) * ray.inverse[axis];
  }
  for (double t = begin; t < end;) {
    const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
    const double leave = std::min(next[axis], end);
    if (leave > t) {
      if (!visit(cell, t, leave)) return false;
      t = leave;
    }
    cell[axis] += step[axis];
    if (cell[axis] < 0 || cell[axis] > 7) return true;
    next[axis] += width[axis];
  }
  return true;
}

}  // namespace umbrick
