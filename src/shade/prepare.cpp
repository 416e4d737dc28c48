#include "umbrick/shade/prepare.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "umbrick/core/error.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

double shortestVoxelEdge(const glm::dmat4& indexToWorld) {
  return std::min({glm::length(glm::dvec3(indexToWorld[0])), glm::length(glm::dvec3(indexToWorld[1])),
                   glm::length(glm::dvec3(indexToWorld[2]))});
}

Scene resolveScene(const Scene& scene, const Box& worldBounds, const glm::dmat4& indexToWorld) {
  if (!scene.transfer) throw InvalidArgument("scene: no transfer function");
  validateScene(scene);
  Scene resolved = scene;
  if (resolved.orbit) {
    resolved.camera = orbitCamera(worldBounds, resolved.orbit->azimuth, resolved.orbit->elevation, resolved.camera);
    resolved.orbit.reset();
  }
  if (resolved.sampling.spacingInVoxels) {
    resolved.sampling.spacing *= shortestVoxelEdge(indexToWorld);
    resolved.sampling.spacingInVoxels = false;
  }
  return resolved;
}

int requiredApron(const Scene& resolved, const glm::dmat4& indexToWorld) {
  const IndexView view = indexView(resolved.camera, indexToWorld);
  double reach = 0;
  if (resolved.sampling.quadrature == Quadrature::preintegrated) {
    const glm::dvec3 axes = slabReach(view, resolved.sampling.spacing);
    reach = std::max({axes.x, axes.y, axes.z});
  }
  // Half a voxel belongs to every apron: a brick's space ends half-way between its last voxel and the first ghost. What
  // rounding may add is left to the texture filter.
  const double wanted = std::ceil(0.5 + reach - 1e-9);
  if (!(wanted <= resolved.bricks.interior))
    throw InvalidArgument("sampling: slices " + std::to_string(resolved.sampling.spacing) + " apart reach " +
                          std::to_string(static_cast<long long>(std::min(wanted, 9e15))) +
                          " voxels beyond a brick, more than its edge of " + std::to_string(resolved.bricks.interior));
  return std::max(1, static_cast<int>(wanted));
}

}  // namespace umbrick
