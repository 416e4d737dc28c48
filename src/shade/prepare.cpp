// SPDX-License-Identifier: Apache-2.0
#include "umbrick/shade/prepare.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "umbrick/core/error.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

int requiredApron(const ResolvedScene& resolved, const glm::dmat4& indexToWorld) {
  const IndexView view = indexView(resolved.camera, indexToWorld);
  // Whatever the quadrature: segments and planes that cut slabs have samples anywhere in a slab.
  const glm::dvec3 axes = slabReach(view, resolved.sampling.spacing);
  const double reach = std::max({axes.x, axes.y, axes.z});
  // Half a voxel belongs to every apron: a brick's space ends half-way between its last voxel and the first ghost. What
  // rounding may add is left to the texture filter.
  const double wanted = std::ceil(0.5 + reach - 1e-9);
  const int most = resolved.bricks.interior > 0 ? resolved.bricks.interior : kMostInterior;
  if (!(wanted <= most))
    throw InvalidArgument("sampling: slices " + std::to_string(resolved.sampling.spacing) + " apart reach " +
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
  const double wanted = std::max({24.0, std::min(48.0, 7 * pixelVoxels), 3.0 * apron});
  return std::min(kMostInterior, 8 * static_cast<int>(std::ceil(wanted / 8)));
}

}  // namespace umbrick
