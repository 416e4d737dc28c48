// A solid with an edge whose picture has a closed form: the share of each pixel that the solid covers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <numbers>
#include <vector>

#include "support/coverage.h"
#include "support/test_grids.h"
#include "umbrick/scene/scene.h"

namespace umbrick {

/// Returns the plane that the camera sees as a line, in pixels: it keeps what is seen inside the half-plane.
inline ClipPlane planeSeenAs(const HalfPlane& half, const Camera& camera) {
  const CameraFrame frame = cameraFrame(camera);
  const ScreenPlane screen = screenPlane(camera);
  // A point is seen at pixel (p + halfExtent) / pixelSize, where p is its place across, under perspective over its
  // depth.
  const glm::dvec2 slope = half.normal / screen.pixelSize;
  const double rest = half.offset + glm::dot(slope, screen.halfExtent);
  glm::dvec3 normal = slope.x * frame.right + slope.y * frame.up;
  if (camera.projection == Projection::orthographic) return {normal, rest - glm::dot(normal, camera.eye)};
  normal += rest * frame.forward;
  return {normal, -glm::dot(normal, camera.eye)};
}

/// Returns lines through the middle of a square picture in directions and at places that are not special.
inline std::vector<HalfPlane> edgesThrough(int size, int count) {
  TestRandom random(3);
  std::vector<HalfPlane> edges;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * (i + random.uniform()) / count;
    HalfPlane edge{{std::cos(angle), std::sin(angle)}, 0};
    edge.offset = -edge.at(glm::dvec2(0.5 * size) + glm::dvec2(random.uniform(-2, 2), random.uniform(-2, 2)));
    edges.push_back(edge);
  }
  return edges;
}

/// Returns the root mean square, over the pixels that the edge crosses, of what is left between `found(x, y)` and the
/// share of the pixel inside the half-plane.
template <class Found>
double coverageError(const HalfPlane& edge, int size, const Found& found) {
  double square = 0;
  int crossed = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double share = coverage(edge, x, y);
      if (share <= 0 || share >= 1) continue;
      square += std::pow(found(x, y) - share, 2);
      ++crossed;
    }
  return std::sqrt(square / crossed);
}

}  // namespace umbrick
