// SPDX-License-Identifier: Apache-2.0
#include "sweep/index_planes.h"

#include <glm/geometric.hpp>

namespace umbrick {
namespace {

glm::dvec4 inIndex(const ClipPlane& plane, const glm::dmat4& indexToWorld) {
  const glm::dvec3 normal(plane);
  const auto along = [&](int axis) { return glm::dot(normal, glm::dvec3(indexToWorld[axis])); };
  return {along(0), along(1), along(2), along(3) + plane.w};
}

glm::dvec4 beyond(const ResolvedScene& scene, const Bricks& volume, double depth) {
  const glm::dvec3 forward = cameraFrame(scene.camera).forward;
  return inIndex({forward, -glm::dot(forward, scene.camera.eye) - depth}, volume.indexToWorld);
}

}  // namespace

std::vector<glm::dvec4> indexPlanes(const ResolvedScene& scene, const Bricks& volume, bool backgroundVisible) {
  std::vector<glm::dvec4> planes;
  for (const ClipPlane& plane : scene.clipPlanes) planes.push_back(inIndex(plane, volume.indexToWorld));
  if (scene.clipBox)
    for (const ClipPlane& plane : boxPlanes(*scene.clipBox)) planes.push_back(inIndex(plane, volume.indexToWorld));
  if (backgroundVisible) {
    const IndexBox box = mediumBox(scene.transfer, volume.domain);
    for (const ClipPlane& plane : boxPlanes({glm::dvec3(box.min), glm::dvec3(box.max)})) planes.push_back(plane);
  }
  if (scene.camera.nearDistance > 0) planes.push_back(beyond(scene, volume, scene.camera.nearDistance));
  return planes;
}

glm::dvec4 frontPlane(const ResolvedScene& scene, const Bricks& volume) { return beyond(scene, volume, 0); }

}  // namespace umbrick
