// SPDX-License-Identifier: Apache-2.0
#include "umbrick/scene/resolve.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "scene/gradient_opacity.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {

// Returns the function that a scene shows its medium by.
TransferFunction shownTransfer(const Scene& scene) {
  if (!traitsOf(scene.mode).medium || scene.gradientOpacity == glm::dvec2(0)) return *scene.transfer;
  if (scene.transfer->is2d())
    throw InvalidArgument(
        "gradientOpacity: is for transfer functions of the value alone, which a function of value and gradient "
        "replaces");
  if (scene.gradientUnit == GradientUnit::percent)
    throw InvalidArgument("gradientUnit: percent needs a volume, of whose largest gradient it is");
  return withGradientOpacity(*scene.transfer, scene.gradientOpacity);
}

}  // namespace

std::vector<ClipPlane> boxPlanes(const Box& box, const glm::dmat4& toWorld) {
  const glm::dmat4 inverse = glm::inverse(toWorld);
  std::vector<ClipPlane> planes;
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec4 coordinate(inverse[0][axis], inverse[1][axis], inverse[2][axis], inverse[3][axis]);
    planes.push_back(coordinate - glm::dvec4(0, 0, 0, box.min[axis]));
    planes.push_back(glm::dvec4(0, 0, 0, box.max[axis]) - coordinate);
  }
  return planes;
}

double shortestVoxelEdge(const glm::dmat4& indexToWorld) {
  return std::min({glm::length(glm::dvec3(indexToWorld[0])), glm::length(glm::dvec3(indexToWorld[1])),
                   glm::length(glm::dvec3(indexToWorld[2]))});
}

OrbitView orbitView(const Orbit& orbit) {
  const Axis up = orbit.up == Axis::automatic ? Axis::z : orbit.up;
  const Axis front = orbit.front == Axis::automatic ? usualFront(up) : orbit.front;
  return {orbit.azimuth, orbit.elevation, axisDirection(up), axisDirection(front), orbit.zoom, orbit.pan};
}

ResolvedScene resolveScene(const Scene& scene, const Box& worldBounds, const glm::dmat4& indexToWorld) {
  if (!scene.transfer) throw InvalidArgument("scene: no transfer function");
  validateScene(scene);
  ResolvedScene resolved(scene, shownTransfer(scene));
  if (emits(scene)) resolved.emitted = emissionFunction(scene.emission);
  if (scene.orbit) resolved.camera = orbitCamera(worldBounds, orbitView(*scene.orbit), scene.camera);
  if (scene.spacingUnit == SpacingUnit::voxel) resolved.sampling.spacing *= shortestVoxelEdge(indexToWorld);
  return resolved;
}

Scene unresolved(const ResolvedScene& scene) {
  Scene written;
  static_cast<SceneSettings&>(written) = scene;
  written.transfer = scene.transfer;
  if (traitsOf(scene.mode).medium && scene.gradientOpacity != glm::dvec2(0)) {
    // The function is written as it was given. One that was made in another way has no ramp.
    if (auto given = withoutGradientOpacity(scene.transfer, scene.gradientOpacity))
      written.transfer = std::move(given);
    else
      written.gradientOpacity = glm::dvec2(0);
  }
  written.orbit.reset();
  written.spacingUnit = SpacingUnit::world;
  return written;
}

void validateScene(const ResolvedScene& scene) { validateScene(unresolved(scene)); }

std::string printScene(const ResolvedScene& scene) { return printScene(unresolved(scene)); }

IndexBox mediumBox(const TransferFunction& transfer, const IndexBox& domain) {
  if (!transfer.is2d() || domain.empty()) return domain;
  return {domain.min - 1, domain.max + 1};
}

}  // namespace umbrick
