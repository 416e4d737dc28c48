// What half-spaces leave of a ray, as both ways of marching ask for it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <span>

namespace umbrick {

/// A part of a ray: the way along its main axis from its first slice on, voxels.
struct KeptWay {
  float enter = 0, leave = 0;
};

/// Returns the part of a ray that lies in all half-spaces.
/// @param planes  along (u, v, n): dot + w >= 0
/// @param at      where the ray is on its first slice, along u and v; n: the slice
/// @param slope   du/dn and dv/dn; sign: of n on the way
/// @param most    the way's end, beyond which nothing is asked for
inline KeptWay keptWay(std::span<const glm::dvec4> planes, const glm::dvec2& at, double n, const glm::dvec2& slope,
                       int sign, double most) {
  double enter = -1, leave = most;
  for (const glm::dvec4& plane : planes) {
    const double inside = plane.x * at.x + plane.y * at.y + plane.z * n + plane.w;
    const double change = sign * (plane.x * slope.x + plane.y * slope.y + plane.z);
    if (change > 0)
      enter = std::max(enter, -inside / change);
    else if (change < 0)
      leave = std::min(leave, -inside / change);
    else if (inside < 0)
      leave = -1;
  }
  return {static_cast<float>(enter), static_cast<float>(std::max(leave, enter))};
}

}  // namespace umbrick
