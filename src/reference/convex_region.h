// The space that holds the medium: an intersection of half-spaces.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "reference/index_ray.h"
#include "umbrick/core/box.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// An intersection of half-spaces dot(xyz, point) + w >= 0 in index space.
class ConvexRegion {
 public:
  /// The box, the clip planes and the clip box of the scene and what of space the camera sees.
  /// @param behindEye  also what lies behind the plane of the eye
  /// @param margin     by which the box is larger, voxels
  ConvexRegion(const ResolvedScene& scene, const IndexBox& box, const glm::dmat4& indexToWorld, bool behindEye,
               double margin = 0);

  /// Returns the part of the ray with t >= begin that lies inside.
  Interval clip(const IndexRay& ray, double begin) const;

 private:
  std::vector<glm::dvec4> planes_;
};

}  // namespace umbrick
