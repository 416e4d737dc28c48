// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/camera.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {

bool isFinite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

std::string print(double number) { return std::to_string(number); }

void checkNumbers(const Camera& camera) {
  if (!isFinite(camera.eye) || !isFinite(camera.lookAt) || !isFinite(camera.up))
    throw InvalidArgument("camera: eye, look-at and up must be finite numbers");
  if (camera.width < 1 || camera.height < 1)
    throw InvalidArgument("camera: size is " + std::to_string(camera.width) + " x " + std::to_string(camera.height) +
                          ", must be at least 1 x 1");
  if (camera.projection == Projection::perspective && !(camera.fov > 0 && camera.fov < std::numbers::pi))
    throw InvalidArgument("camera: fov is " + print(camera.fov * 180 / std::numbers::pi) +
                          " degrees, must be in (0, 180)");
  if (camera.projection == Projection::orthographic && !(camera.viewHeight > 0 && std::isfinite(camera.viewHeight)))
    throw InvalidArgument("camera: view height is " + print(camera.viewHeight) + ", must be above 0");
  if (!(camera.nearDistance >= 0 && std::isfinite(camera.nearDistance)))
    throw InvalidArgument("camera: near distance is " + print(camera.nearDistance) + ", must be 0 or more");
}
}  // namespace

CameraFrame cameraFrame(const Camera& camera) {
  checkNumbers(camera);
  const glm::dvec3 view = camera.lookAt - camera.eye;
  const double distance = glm::length(view);
  if (!(distance > 0)) throw InvalidArgument("camera: eye and look-at are the same point");
  CameraFrame frame;
  frame.forward = view / distance;
  const double upLength = glm::length(camera.up);
  const glm::dvec3 right = upLength > 0 ? glm::cross(frame.forward, camera.up / upLength) : glm::dvec3(0);
  const double sine = glm::length(right);
  if (!(sine > 1e-9)) throw InvalidArgument("camera: up is parallel to the view direction");
  frame.right = right / sine;
  frame.up = glm::cross(frame.right, frame.forward);
  return frame;
}

ScreenPlane screenPlane(const Camera& camera) {
  checkNumbers(camera);
  const double halfHeight =
      camera.projection == Projection::perspective ? std::tan(0.5 * camera.fov) : 0.5 * camera.viewHeight;
  const double pixel = 2 * halfHeight / camera.height;
  return {{0.5 * pixel * camera.width, halfHeight}, {pixel, pixel}};
}

Camera orbitCamera(const Box& bounds, double azimuth, double elevation, Camera base) {
  if (bounds.empty()) throw InvalidArgument("camera: the volume is empty, so there is nothing to look at");
  if (!std::isfinite(azimuth) || !std::isfinite(elevation))
    throw InvalidArgument("camera: azimuth and elevation must be finite numbers");
  Camera camera = base;
  camera.lookAt = bounds.centre();
  camera.eye = camera.lookAt + glm::dvec3(0, -1, 0);  // any valid place; it is replaced below
  checkNumbers(camera);
  // A single voxel has no extent, and any positive number will do as its radius.
  double radius = 0.5 * glm::length(bounds.extent());
  if (!(radius > 0)) radius = 1;
  const double aspect = std::min(1.0, static_cast<double>(camera.width) / camera.height);
  double distance;
  if (camera.projection == Projection::perspective) {
    // The sphere touches the narrower pair of frustum planes.
    const double halfAngle = std::atan(std::tan(0.5 * camera.fov) * aspect);
    distance = radius / std::sin(halfAngle);
  } else {
    camera.viewHeight = 2 * radius / aspect;
    distance = 2 * radius;
  }
  const double ca = std::cos(azimuth), sa = std::sin(azimuth), ce = std::cos(elevation), se = std::sin(elevation);
  camera.eye = camera.lookAt + distance * glm::dvec3(sa * ce, -ca * ce, se);
  camera.up = glm::dvec3(-sa * se, ca * se, ce);  // derivative by elevation of the direction to the eye
  return camera;
}

}  // namespace umbrick
