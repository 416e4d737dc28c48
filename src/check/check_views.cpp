// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "umbrick/check/invariants.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

// Directions along the grid: `forward` straight at its faces of constant y, `up` along z as far as that allows.
struct GridFrame {
  glm::dvec3 right, up, forward;
  glm::dvec3 thickness;  // extent of a voxel along each direction, world units
};

GridFrame gridFrame(const glm::dmat4& indexToWorld) {
  const glm::dvec3 x(indexToWorld[0]), y(indexToWorld[1]), z(indexToWorld[2]);
  GridFrame frame;
  frame.forward = glm::normalize(glm::cross(z, x));
  if (glm::dot(frame.forward, y) < 0) frame.forward = -frame.forward;
  frame.up = glm::normalize(z);
  frame.right = glm::cross(frame.forward, frame.up);
  frame.thickness = {std::abs(glm::dot(x, frame.right)), glm::length(z), glm::dot(y, frame.forward)};
  return frame;
}

Camera lookingAlong(const Camera& base, const Box& bounds, const glm::dvec3& forward, const glm::dvec3& up) {
  Camera camera = orbitCamera(bounds, 0, 0, base);  // only its distance matters
  camera.eye = camera.lookAt - forward * glm::length(camera.lookAt - camera.eye);
  camera.up = up;
  return camera;
}

// Returns a parallel view along the grid's y. Pixel centres lie on faces of x and, where the grid's axes are
// perpendicular and its voxels cubes, of z. A slice lies at every half voxel, so that slices lie on faces and
// on voxel centres.
CheckView alignedView(const Camera& base, const ScalarGrid& grid, const Box& bounds, const GridFrame& frame) {
  CheckView view{"parallel, slices and pixels on faces", lookingAlong(base, bounds, frame.forward, frame.up), 0};
  Camera& camera = view.camera;
  // Pixels are 2^k voxels wide: about as large as the fitting view's, but each hits the same places of a voxel.
  const double voxel = frame.thickness.x;
  const double pixel = voxel * std::exp2(std::round(std::log2(camera.viewHeight / camera.height / voxel)));
  const double step = pixel / voxel;
  camera.viewHeight = pixel * camera.height;
  view.spacing = 0.5 * frame.thickness.z;
  const glm::dmat4 toWorld = grid.indexToWorld();
  const IndexBox box = grid.activeBox();
  const glm::dvec3 middle = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
  // The eye is half a pixel beside a face, or on it for an odd number of pixels, and a quarter of a voxel from one.
  const double face = 64 * std::round(middle.x / 64) - 0.5, row = 64 * std::round(middle.z / 64) - 0.5;
  const double back = std::ceil(glm::length(camera.lookAt - camera.eye) / frame.thickness.z);
  const auto odd = [](int pixels) { return pixels % 2 != 0; };
  const glm::dvec3 eye(face - (odd(camera.width) ? 0 : 0.5 * step), std::round(middle.y) - back - 0.25,
                       row - (odd(camera.height) ? 0 : 0.5 * step));
  camera.eye = glm::dvec3(toWorld * glm::dvec4(eye, 1));
  camera.lookAt = camera.eye + frame.forward * (back * frame.thickness.z);
  return view;
}

}  // namespace

std::vector<CheckView> checkViews(const ScalarGrid& grid, const ResolvedScene& resolved) {
  const Box bounds = grid.worldBounds();
  if (bounds.empty()) throw InvalidArgument("check: grid \"" + grid.name + "\" has no active voxel");
  const GridFrame frame = gridFrame(grid.indexToWorld());
  Camera perspective;
  perspective.width = resolved.camera.width;
  perspective.height = resolved.camera.height;
  Camera parallel = perspective;
  parallel.projection = Projection::orthographic;
  const glm::dvec3 diagonal = glm::normalize(frame.forward + frame.right - 0.9 * frame.up);
  std::vector<CheckView> views;
  views.push_back({"face-on", lookingAlong(perspective, bounds, frame.forward, frame.up), 0});
  views.push_back({"diagonal", lookingAlong(perspective, bounds, diagonal, frame.up), 0});
  Camera inside = perspective;
  inside.fov = 1.4;  // rad; it shows nearly as much to the side as ahead
  inside.eye = bounds.centre() - 0.1 * bounds.extent();
  inside.lookAt = inside.eye + glm::normalize(2.0 * frame.forward + frame.right + 0.5 * frame.up) *
                                   std::max(glm::length(bounds.extent()), frame.thickness.z);
  inside.up = frame.up;
  views.push_back({"inside", inside, 0});
  views.push_back({"parallel, face-on", lookingAlong(parallel, bounds, frame.forward, frame.up), 0});
  views.push_back({"parallel, diagonal", lookingAlong(parallel, bounds, diagonal, frame.up), 0});
  views.push_back(alignedView(parallel, grid, bounds, frame));
  return views;
}

}  // namespace umbrick
