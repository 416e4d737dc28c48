// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/turned_camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "umbrick/core/error.h"

namespace umbrick {

Camera turnedCamera(const Camera& camera, const glm::dvec3& centre, const glm::dvec3& axis, double angle) {
  const double length = glm::length(axis);
  if (!(length > 0)) throw InvalidArgument("camera: the axis that it turns around has no length");
  if (angle == 0) return camera;  // to the last bit
  const glm::dvec3 unit = axis / length;
  const double cosine = std::cos(angle), sine = std::sin(angle);
  // Rodrigues' formula.
  const auto turned = [&](const glm::dvec3& v) {
    return cosine * v + sine * glm::cross(unit, v) + (1 - cosine) * glm::dot(unit, v) * unit;
  };
  Camera result = camera;
  result.eye = centre + turned(camera.eye - centre);
  result.lookAt = centre + turned(camera.lookAt - centre);
  result.up = turned(camera.up);
  return result;
}

double rollBetween(const Camera& from, const Camera& to) {
  const CameraFrame a = cameraFrame(from), b = cameraFrame(to);
  // The smallest rotation that takes one direction of view to the other one.
  const double cosine = glm::dot(a.forward, b.forward);
  if (cosine < -1 + 1e-12) return 0;  // opposite directions: any rotation does
  const glm::dvec3 axis = glm::cross(a.forward, b.forward);
  const glm::dvec3 carried = a.up * cosine + glm::cross(axis, a.up) + axis * (glm::dot(axis, a.up) / (1 + cosine));
  return std::acos(std::clamp(glm::dot(carried, b.up), -1.0, 1.0));
}

}  // namespace umbrick
