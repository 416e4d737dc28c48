// Pictures of modes that show values, by rays on the CPU.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <memory>
#include <optional>
#include <string_view>

#include "support/test_grids.h"
#include "support/test_scenes.h"
#include "sweep/surface_rays.h"
#include "umbrick/brick/brick_grid.h"
#include "umbrick/draw/value_picture.h"
#include "umbrick/reference/reference.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/sweep/ray_renderer.h"

namespace umbrick {

inline SceneSurface surfaceAt(double value, double opacity = 1) {
  SceneSurface surface;
  surface.value = value;
  surface.opacity = opacity;
  return surface;
}

inline std::unique_ptr<Bricks> valueBricks(const ScalarGrid& grid, const ResolvedScene& scene) {
  BrickOptions bricks;
  bricks.interior = scene.bricks.interior;
  bricks.apron = traitsOf(scene.mode).surfaces ? surfaceApron(scene) : isShaded(scene) ? kGradientApron : 1;
  bricks.gradients = scene.transfer.is2d();
  bricks.gradientFilter = scene.gradients;
  return cutGrid(grid, bricks, scene.bricks.bricked);
}

inline Picture valuePicture(const ScalarGrid& grid, const ResolvedScene& scene, std::optional<int> perVoxel = {},
                            bool layers = false) {
  RenderOptions options;
  options.visibilityAndDepth = layers;
  const auto volume = valueBricks(grid, scene);
  return RayRenderer(*volume, scene, options, perVoxel).render();
}

template <class AnyPicture>
const Image& layerOf(const AnyPicture& picture, std::string_view name) {
  return std::ranges::find(picture.layers, name, &ImageLayer::name)->image;
}

/// A parallel view along an axis, one pixel a voxel: its ray goes through the voxels of a column of a box from 0 on.
/// Columns of pixels follow the next axis (x, y, z, x), rows the one after that.
inline Camera faceOnCamera(const glm::ivec3& dims, int axis) {
  const int right = (axis + 1) % 3, up = (axis + 2) % 3;
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.lookAt = 0.5 * glm::dvec3(dims - 1);
  camera.eye = camera.lookAt;
  // right = forward x up, so that looking against the axis keeps the frame right-handed.
  camera.eye[axis] += dims[axis] + 10.0;
  camera.up = glm::dvec3(0);
  camera.up[up] = 1;
  camera.width = dims[right];
  camera.height = dims[up];
  camera.viewHeight = dims[up];
  return camera;
}

}  // namespace umbrick
