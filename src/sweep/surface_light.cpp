// SPDX-License-Identifier: Apache-2.0
#include "sweep/surface_light.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "sweep/index_planes.h"
#include "umbrick/scene/surface_light.h"

namespace umbrick {

SurfaceLight::SurfaceLight(const Bricks& volume)
    : volume_(volume), toIndex_(glm::inverse(glm::dmat3(volume.indexToWorld))), light_(volume) {}

void SurfaceLight::update(const ResolvedScene& scene, const RenderSample& sample, BrickVoxels& voxels,
                          RenderStats& stats) {
  const bool backgroundVisible = showsBackground(scene.transfer, volume_);
  light_.update(lightAtSurfaces(volume_, scene, lightsOf(scene, sample)), scene,
                indexPlanes(scene, volume_, backgroundVisible), volume_.layout);
  light_.store(voxels);
  light_.addTo(stats);
}

glm::dvec3 SurfaceLight::shareAt(const VoxelBrick& brick, const glm::dvec3& at, const glm::dvec3& normal) const {
  const glm::ivec3 edge = volume_.layout.edge();
  const glm::dvec3 place = glm::clamp(at + towardsLight(toIndex_, normal) + static_cast<double>(volume_.layout.apron),
                                      glm::dvec3(0), glm::dvec3(edge - 1));
  const glm::ivec3 voxel = glm::min(glm::ivec3(place), edge - 2);
  const glm::dvec3 upper = place - glm::dvec3(voxel);
  const std::ptrdiff_t strideY = edge.x, strideZ = strideY * edge.y;
  const std::size_t count = volume_.layout.voxels();
  const auto channels = static_cast<std::size_t>(light_.channels());
  glm::dvec3 sum(0);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::dvec3 weights = glm::mix(1.0 - upper, upper, glm::dvec3(step));
    const double weight = weights.x * weights.y * weights.z;
    const glm::ivec3 from = voxel + step;
    const auto place1d = static_cast<std::size_t>(from.z * strideZ + from.y * strideY + from.x);
    for (std::size_t c = 0; c < channels; ++c)
      sum[static_cast<glm::length_t>(c)] += weight * brick.light[c * count + place1d];
  }
  if (channels == 1) sum = glm::dvec3(sum.x);
  // Beyond planes that cut the medium there is more light than arrives.
  return glm::min(sum * static_cast<double>(light_.unit()), 1.0);
}

}  // namespace umbrick
