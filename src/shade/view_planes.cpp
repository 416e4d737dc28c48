// SPDX-License-Identifier: Apache-2.0
#include "shade/view_planes.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace umbrick {
namespace {

// In world units like all planes: their distances are those of the camera's.
std::vector<ClipPlane> mediumPlanes(const ResolvedScene& scene, const Bricks& volume) {
  const IndexBox box = mediumBox(scene.transfer, volume.domain);
  return boxPlanes({glm::dvec3(box.min), glm::dvec3(box.max)}, volume.indexToWorld);
}

}  // namespace

std::vector<glm::dvec4> viewPlanes(const ResolvedScene& scene, const Bricks& volume, bool backgroundVisible) {
  std::vector<ClipPlane> planes = scene.clipPlanes;
  const auto append = [&](const std::vector<ClipPlane>& more) {
    planes.insert(planes.end(), more.begin(), more.end());
  };
  if (scene.clipBox) append(boxPlanes(*scene.clipBox));
  if (backgroundVisible) append(mediumPlanes(scene, volume));
  for (ClipPlane& plane : planes) plane = planeInView(plane, scene.camera);
  if (scene.camera.nearDistance > 0) planes.emplace_back(0, 0, 1, -scene.camera.nearDistance);
  return planes;
}

std::vector<glm::dvec4> viewBounds(const ResolvedScene& scene, const Bricks& volume, bool backgroundVisible,
                                   std::vector<glm::dvec4> planes) {
  if (backgroundVisible || volume.domain.empty()) return planes;
  for (const ClipPlane& plane : mediumPlanes(scene, volume)) planes.push_back(planeInView(plane, scene.camera));
  return planes;
}

glm::dvec4 planeInIndex(const glm::dvec4& plane, const IndexView& view) {
  const glm::dvec3 n(plane);
  return {glm::dot(n, view.axis[0]), glm::dot(n, view.axis[1]), glm::dot(n, view.axis[2]),
          glm::dot(n, view.origin) + plane.w};
}

double domainDiagonal(const Bricks& volume) {
  const glm::dvec3 extent(volume.domain.extent());
  double longest = 0;
  for (unsigned c = 0; c < 4; ++c)
    longest = std::max(longest, glm::length(glm::dmat3(volume.indexToWorld) *
                                            (extent * glm::dvec3(1, c & 1 ? -1 : 1, c & 2 ? -1 : 1))));
  return longest;
}

}  // namespace umbrick
