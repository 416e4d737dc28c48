// Scenes, view rays and how far pictures differ: for tests of whatever makes a picture.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "umbrick/image/image.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

inline constexpr double kDegree = std::numbers::pi / 180;

/// Single precision: half a unit in the last place of numbers near 1.
inline constexpr double kFloatRounding = 6e-8;

/// The ray of a pixel's centre: at(depth) for depth along the view axis.
struct ViewRay {
  glm::dvec3 origin, direction;
  glm::dvec3 at(double depth) const { return origin + depth * direction; }
  double stretch() const { return glm::length(direction); }  // world length per unit of depth
};

/// @param x,y  pixels, centres at halves
inline ViewRay viewRay(const Camera& camera, double x, double y) {
  const CameraFrame frame = cameraFrame(camera);
  const ScreenPlane screen = screenPlane(camera);
  const glm::dvec2 p = glm::dvec2(x, y) * screen.pixelSize - screen.halfExtent;
  const glm::dvec3 across = p.x * frame.right + p.y * frame.up;
  if (camera.projection == Projection::perspective) return {camera.eye, frame.forward + across};
  return {camera.eye + across, frame.forward};
}

/// Depths of a ray in front of the eye that half-spaces keep.
struct DepthInterval {
  double first = 0, last = std::numeric_limits<double>::infinity();
  double length() const { return std::max(0.0, last - first); }
  double middle() const { return 0.5 * (first + last); }
};

inline DepthInterval keptDepths(const ViewRay& ray, std::span<const ClipPlane> planes) {
  DepthInterval kept;
  for (const ClipPlane& plane : planes) {
    const glm::dvec3 normal(plane);
    const double distance = glm::dot(normal, ray.origin) + plane.w, rate = glm::dot(normal, ray.direction);
    if (rate > 0)
      kept.first = std::max(kept.first, -distance / rate);
    else if (rate < 0)
      kept.last = std::min(kept.last, -distance / rate);
    else if (distance < 0)
      kept.last = -1;
  }
  return kept;
}

inline Camera orthographicCamera(const glm::dvec3& eye, const glm::dvec3& lookAt, double viewHeight, int size) {
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.eye = eye;
  camera.lookAt = lookAt;
  camera.up = {0.1, 1, 0.2};
  camera.viewHeight = viewHeight;
  camera.width = camera.height = size;
  return camera;
}

inline Camera perspectiveCamera(const glm::dvec3& eye, const glm::dvec3& lookAt, double fov, int size) {
  Camera camera = orthographicCamera(eye, lookAt, 1, size);
  camera.projection = Projection::perspective;
  camera.fov = fov;
  return camera;
}

inline TransferFunction homogeneous(const glm::dvec3& albedo, double sigma_t) {
  return TransferFunction({{0, {albedo, sigma_t}}});
}

/// Resolves a scene whose camera is placed, for no volume in particular: a voxel's edge is a world unit.
inline ResolvedScene resolvedAnywhere(const Scene& scene) { return resolveScene(scene, {}, glm::dmat4(1)); }

/// A scene without early rejection of saturated pixels: what is left is the method itself.
inline ResolvedScene plainScene(const TransferFunction& transfer, const Camera& camera, double spacing) {
  Scene scene;
  scene.transfer = transfer;
  scene.camera = camera;
  scene.orbit.reset();
  scene.method = Method::dos;  // what tests of `cone` that name no method are about
  scene.sampling.spacing = spacing;
  scene.spacingUnit = SpacingUnit::world;
  scene.sampling.saturation = 0;
  scene.bricks.interior = 16;
  return resolvedAnywhere(scene);
}

/// Largest difference of two images over all channels.
inline double maxDifference(const Image& a, const Image& b) {
  double largest = a.pixels.size() == b.pixels.size() ? 0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.pixels.size() && i < b.pixels.size(); ++i)
    largest = std::max(largest, std::abs(static_cast<double>(a.pixels[i]) - static_cast<double>(b.pixels[i])));
  return largest;
}

}  // namespace umbrick
