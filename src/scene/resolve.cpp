#include "umbrick/scene/resolve.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "umbrick/core/error.h"

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

IndexBox mediumBox(const TransferFunction& transfer, const IndexBox& domain) {
  if (!transfer.is2d() || domain.empty()) return domain;
  return {domain.min - 1, domain.max + 1};
}

}  // namespace umbrick
