// A line in continuous index space.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <limits>

namespace umbrick {

inline double largestComponent(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// origin + t direction. t is a length in world units.
struct IndexRay {
  IndexRay() = default;
  IndexRay(const glm::dvec3& from, const glm::dvec3& along)
      : origin(from), direction(along), inverse(1.0 / along), perVoxel(1 / largestComponent(along)) {}

  glm::dvec3 origin{0}, direction{0};
  glm::dvec3 inverse{std::numeric_limits<double>::infinity()};  // of each component of the direction
  double perVoxel = 0;                                          // t by which the fastest coordinate changes by 1

  glm::dvec3 at(double t) const { return origin + t * direction; }
};

/// Part of a ray.
struct Interval {
  double begin = 0, end = 0;
  bool empty() const { return !(begin < end); }
};

/// A step along the ray that is nothing to the field and yet leads off a face: 1e-7 voxels, or more where coordinates
/// are so large that double precision has no such step.
inline double nudgeOf(const IndexRay& ray, const glm::dvec3& at) {
  return std::max(1e-7, 0x1p-48 * largestComponent(at)) * ray.perVoxel;
}

/// Where a ray leaves the box [low, high] that it is in.
inline double exitOf(const IndexRay& ray, const glm::dvec3& low, const glm::dvec3& high) {
  double exit = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double d = ray.direction[axis];
    if (d != 0) exit = std::min(exit, ((d > 0 ? high[axis] : low[axis]) - ray.origin[axis]) * ray.inverse[axis]);
  }
  return exit;
}

/// Whole number below, of a number that an int holds.
inline int floorToInt(double x) {
  const int whole = static_cast<int>(x);
  return whole - (x < whole ? 1 : 0);
}

}  // namespace umbrick
