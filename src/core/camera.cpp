// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/camera.h"

#include <algorithm>
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

void checkView(const OrbitView& view) {
  if (!std::isfinite(view.azimuth) || !std::isfinite(view.elevation))
    throw InvalidArgument("camera: azimuth and elevation must be finite numbers");
  constexpr double kRounding = 1e-9;
  if (!(std::abs(glm::length(view.up) - 1) < kRounding && std::abs(glm::length(view.front) - 1) < kRounding &&
        std::abs(glm::dot(view.up, view.front)) < kRounding))
    throw InvalidArgument("camera: up and front must be two different axes");
  if (!(view.zoom > 0 && std::isfinite(view.zoom)))
    throw InvalidArgument("camera: zoom is " + print(view.zoom) + ", must be above 0");
  if (!std::isfinite(view.pan.x) || !std::isfinite(view.pan.y))
    throw InvalidArgument("camera: pan must be finite numbers");
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
  return orbitCamera(bounds, OrbitView{azimuth, elevation}, base);
}

Camera orbitCamera(const Box& bounds, const OrbitView& view, Camera base) {
  if (bounds.empty()) throw InvalidArgument("camera: the volume is empty, so there is nothing to look at");
  checkView(view);
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
  const double ca = std::cos(view.azimuth), sa = std::sin(view.azimuth);
  const double ce = std::cos(view.elevation), se = std::sin(view.elevation);
  const glm::dvec3 side = glm::cross(view.up, view.front);  // where the eye is at azimuth 90
  camera.eye = camera.lookAt + distance * (sa * ce * side + ca * ce * view.front + se * view.up);
  camera.up = -sa * se * side - ca * se * view.front + ce * view.up;  // derivative of the eye's direction by elevation
  // Zooming cuts a part out of the picture, and panning moves eye and target alike, so that the perspective stays.
  const double height =
      camera.projection == Projection::perspective ? 2 * distance * std::tan(0.5 * camera.fov) : camera.viewHeight;
  if (camera.projection == Projection::perspective)
    camera.fov = view.zoom == 1 ? camera.fov : 2 * std::atan(std::tan(0.5 * camera.fov) / view.zoom);
  else
    camera.viewHeight /= view.zoom;
  if (view.pan != glm::dvec2(0)) {
    const CameraFrame frame = cameraFrame(camera);
    const glm::dvec3 shift = -height / view.zoom * (view.pan.x * frame.right + view.pan.y * frame.up);
    camera.eye += shift;
    camera.lookAt += shift;
  }
  return camera;
}

double fillingZoom(const Camera& camera, const Box& box) {
  if (box.empty()) throw InvalidArgument("camera: the volume is empty, so there is nothing to look at");
  const CameraFrame frame = cameraFrame(camera);
  const ScreenPlane plane = screenPlane(camera);
  double most = 0;  // of the halves of the picture that a corner reaches
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 point(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                           corner & 4 ? box.max.z : box.min.z);
    const glm::dvec3 offset = point - camera.eye;
    const double depth = camera.projection == Projection::perspective ? glm::dot(offset, frame.forward) : 1;
    if (!(depth > 0)) return 1;  // the eye is inside
    most = std::max({most, std::abs(glm::dot(offset, frame.right)) / depth / plane.halfExtent.x,
                     std::abs(glm::dot(offset, frame.up)) / depth / plane.halfExtent.y});
  }
  constexpr double kFilled = 0.92;
  return most > 0 ? kFilled / most : 1;
}

}  // namespace umbrick
