// SPDX-License-Identifier: Apache-2.0
#include "reference/convex_region.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "umbrick/core/camera.h"

namespace umbrick {

ConvexRegion::ConvexRegion(const ResolvedScene& scene, const IndexBox& box, const glm::dmat4& indexToWorld,
                           bool behindEye, double margin) {
  std::vector<glm::dvec4> world = scene.clipPlanes;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec4 low(0), high(0);
    low[axis] = 1;
    high[axis] = -1;
    if (scene.clipBox) {
      low.w = -scene.clipBox->min[axis];
      high.w = scene.clipBox->max[axis];
      world.push_back(low);
      world.push_back(high);
    }
    low.w = margin - box.min[axis];
    high.w = margin + box.max[axis];
    planes_.push_back(low);
    planes_.push_back(high);
  }
  if (!behindEye || scene.camera.nearDistance > 0) {
    const glm::dvec3 forward = cameraFrame(scene.camera).forward;
    world.emplace_back(forward, -glm::dot(forward, scene.camera.eye) - scene.camera.nearDistance);
  }
  // Planes are transformed by the transpose of the matrix that takes index space to world space.
  for (const glm::dvec4& plane : world) planes_.push_back(glm::transpose(indexToWorld) * plane);
}

Interval ConvexRegion::clip(const IndexRay& ray, double begin) const {
  Interval inside{begin, std::numeric_limits<double>::infinity()};
  for (const glm::dvec4& plane : planes_) {
    const double height = glm::dot(glm::dvec3(plane), ray.origin) + plane.w;
    const double slope = glm::dot(glm::dvec3(plane), ray.direction);
    if (slope > 0)
      inside.begin = std::max(inside.begin, -height / slope);
    else if (slope < 0)
      inside.end = std::min(inside.end, -height / slope);
    else if (height < 0)
      return {0, 0};
  }
  return inside;
}

}  // namespace umbrick
