// The ray of a pixel through the voxels, for modes that show values.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <span>

#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

/// The points origin + t direction of index space, where t is the depth along the view axis, world units.
struct ValueRay {
  glm::dvec3 origin{0}, direction{0};
  double enter = 0, leave = -1;  // the part that counts

  bool empty() const { return !(enter <= leave); }
  glm::dvec3 at(double t) const { return origin + t * direction; }

  /// Cuts off what lies outside of half-spaces dot(xyz, point) + w >= 0.
  void clip(std::span<const glm::dvec4> planes) {
    for (const glm::dvec4& plane : planes) {
      const double inside = glm::dot(glm::dvec3(plane), origin) + plane.w;
      const double change = glm::dot(glm::dvec3(plane), direction);
      if (change > 0)
        enter = std::max(enter, -inside / change);
      else if (change < 0)
        leave = std::min(leave, -inside / change);
      else if (inside < 0)
        leave = -std::numeric_limits<double>::infinity();
    }
  }
};

/// Returns the ray from the eye, or from its plane, on. @param screen  see IndexView
inline ValueRay valueRay(const IndexView& view, const glm::dvec2& screen) {
  const glm::dvec3 aside = screen.x * view.toIndex[0] + screen.y * view.toIndex[1];
  ValueRay ray;
  ray.leave = std::numeric_limits<double>::infinity();
  const bool perspective = view.projection == Projection::perspective;
  ray.origin = perspective ? view.eyeIndex : view.eyeIndex + aside;
  ray.direction = perspective ? view.toIndex[2] + aside : view.toIndex[2];
  return ray;
}

}  // namespace umbrick
