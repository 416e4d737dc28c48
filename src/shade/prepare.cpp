// SPDX-License-Identifier: Apache-2.0
#include "umbrick/shade/prepare.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <string>

#include "umbrick/core/error.h"
#include "umbrick/draw/value_picture.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {
namespace {

// Returns the same as requiredApron, but for all views that have the scene's angle of view and slabs.
double apronOfAnyView(const ResolvedScene& scene, const glm::dmat4& indexToWorld) {
  const glm::dmat3 toIndex = glm::transpose(glm::inverse(glm::dmat3(indexToWorld)));  // its columns are the axes' rows
  const glm::dvec2 corner =
      scene.camera.projection == Projection::perspective ? screenPlane(scene.camera).halfExtent : glm::dvec2(0);
  const double ray = std::sqrt(1 + glm::dot(corner, corner));  // the longest view ray, by depth
  const double voxels = std::max({glm::length(toIndex[0]), glm::length(toIndex[1]), glm::length(toIndex[2])});
  return std::ceil(0.5 + 0.5 * scene.sampling.spacing * ray * voxels - 1e-9);
}

}  // namespace

AtlasOptions atlasOptions(const ResolvedScene& scene, const Bricks& volume, const AtlasLimits& limits) {
  AtlasOptions options;
  options.format = parseVoxelFormat(scene.bricks.format, volume);
  options.budgetBytes = limits.budgetBytes > 0 ? limits.budgetBytes : scene.bricks.budgetMiB << 20;
  // A light volume lies in textures of their own beside those of the bricks, in 32 bits a voxel.
  if (limits.budgetBytes == 0 && occlusionMethod(scene) == Method::lightVolume) {
    const std::uint64_t bytes = options.format == VoxelFormat::unorm8    ? 1
                                : options.format == VoxelFormat::float32 ? 4
                                                                         : 2;
    options.budgetBytes = options.budgetBytes * bytes / (bytes + 4);
  }
  options.maxTextureBytes = limits.maxTextureBytes;
  options.maxTextureEdge = limits.maxTextureEdge;
  return options;
}

BrickOptions requiredBricks(const ResolvedScene& scene, const glm::dmat4& indexToWorld, const Box& worldBounds) {
  BrickOptions options;
  options.interior = brickInterior(scene, indexToWorld, worldBounds);
  options.apron = requiredApron(scene, indexToWorld);
  const double any = apronOfAnyView(scene, indexToWorld);
  if (any <= options.interior) options.apron = std::max(options.apron, static_cast<int>(any));
  if (isShaded(scene)) options.apron = std::max(options.apron, kGradientApron);
  if (traitsOf(scene.mode).surfaces) options.apron = std::max(options.apron, surfaceApron(scene));
  options.gradients = scene.transfer.is2d();
  options.gradientFilter = scene.gradients;
  return options;
}

int requiredApron(const ResolvedScene& resolved, const glm::dmat4& indexToWorld) {
  const IndexView view = indexView(resolved.camera, indexToWorld);
  // Slabs count as half their length whatever the quadrature: segments and planes that cut slabs have samples anywhere
  // in a slab.
  const glm::dvec3 axes = slabReach(view, resolved.sampling.spacing);
  const double reach = std::max({axes.x, axes.y, axes.z});
  // Half a voxel belongs to every apron: a brick's space ends half-way between its last voxel and the first ghost
  // voxel. What rounding may add beyond that is left to the texture filter.
  const double wanted = std::ceil(0.5 + reach - 1e-9);
  const int most = resolved.bricks.interior > 0 ? resolved.bricks.interior : kMostInterior;
  if (!(wanted <= most))
    throw InvalidArgument("sampling.spacing: slices " + std::to_string(resolved.sampling.spacing) + " apart reach " +
                          std::to_string(static_cast<long long>(std::min(wanted, 9e15))) +
                          " voxels beyond a brick, more than its edge of " + std::to_string(most));
  return std::max(1, static_cast<int>(wanted));
}

int brickInterior(const ResolvedScene& resolved, const glm::dmat4& indexToWorld, const Box& worldBounds) {
  const int apron = requiredApron(resolved, indexToWorld);
  if (resolved.bricks.interior > 0) return resolved.bricks.interior;
  const Camera& camera = resolved.camera;
  double pixel = screenPlane(camera).pixelSize.y;  // world units
  if (camera.projection == Projection::perspective) {
    const glm::dvec3 middle = 0.5 * (worldBounds.min + worldBounds.max);
    pixel *= std::max(0.0, glm::dot(middle - camera.eye, cameraFrame(camera).forward));
  }
  const double pixelVoxels = pixel / shortestVoxelEdge(indexToWorld);
  const double wanted = std::max({static_cast<double>(kDefaultInterior), std::min(48.0, 7 * pixelVoxels), 3.0 * apron});
  return std::min(kMostInterior, 8 * static_cast<int>(std::ceil(wanted / 8)));
}

}  // namespace umbrick
