// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "umbrick/core/error.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

glm::dvec3 IndexView::toView(const glm::dvec3& index) const {
  return ((axis[0] * index.x + axis[1] * index.y) + axis[2] * index.z) + origin;
}

IndexView indexView(const Camera& camera, const glm::dmat4& indexToWorld) {
  const CameraFrame frame = cameraFrame(camera);
  const glm::dmat3 linear(indexToWorld);
  // Whether the transform can be inverted must not depend on its scale, so the volume of a voxel is compared with that
  // of the box that has the same edges.
  const double volume = std::abs(glm::determinant(linear));
  const double box = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  if (!(box > 0) || !std::isfinite(box) || !(volume > 1e-12 * box))
    throw InvalidArgument("the grid's transform is singular or not finite");
  const glm::dmat3 inverse = glm::inverse(linear);
  IndexView view;
  const auto toView = [&](const glm::dvec3& v) {
    return glm::dvec3(glm::dot(v, frame.right), glm::dot(v, frame.up), glm::dot(v, frame.forward));
  };
  for (int i = 0; i < 3; ++i) view.axis[static_cast<std::size_t>(i)] = toView(linear[i]);
  view.origin = toView(glm::dvec3(indexToWorld[3]) - camera.eye);
  view.projection = camera.projection;
  view.halfExtent = screenPlane(camera).halfExtent;
  view.size = {camera.width, camera.height};
  view.toIndex = {inverse * frame.right, inverse * frame.up, inverse * frame.forward};
  view.eyeIndex = inverse * (camera.eye - glm::dvec3(indexToWorld[3]));
  return view;
}

glm::dvec4 planeInView(const glm::dvec4& worldPlane, const Camera& camera) {
  const CameraFrame frame = cameraFrame(camera);
  const glm::dvec3 normal(worldPlane);
  return {glm::dot(normal, frame.right), glm::dot(normal, frame.up), glm::dot(normal, frame.forward),
          glm::dot(normal, camera.eye) + worldPlane.w};
}

glm::dvec3 slabReach(const IndexView& view, double spacing) {
  glm::dvec3 reach = glm::abs(view.toIndex[2]);
  // A view ray of a perspective camera is forward + x right + y up, which is longest at a corner of the image.
  if (view.projection == Projection::perspective)
    for (const double x : {-view.halfExtent.x, view.halfExtent.x})
      for (const double y : {-view.halfExtent.y, view.halfExtent.y})
        reach = glm::max(reach, glm::abs(view.toIndex[2] + x * view.toIndex[0] + y * view.toIndex[1]));
  return 0.5 * spacing * reach;
}

}  // namespace umbrick
