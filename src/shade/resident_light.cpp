// SPDX-License-Identifier: Apache-2.0
#include "shade/resident_light.h"

#include <algorithm>

#include "shade/view_planes.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/scene/lights.h"

namespace umbrick {

void ResidentLight::update(const ResolvedScene& scene, const RenderSample& sample, const IndexView& view,
                           std::span<const glm::dvec4> planes, const BrickSelection& bricks) {
  const Stopwatch watch;
  LightMedium medium{
      scene.transfer,
      sample.lights.empty() ? lightDirections(scene, scene.occlusion.ordinates.directions) : sample.lights,
      {},
      {bricks.origins().begin(), bricks.origins().end()},
      scene.occlusion.ordinates.lightSpacing};
  for (const glm::dvec4& plane : planes) {
    const glm::dvec4 inIndex = planeInIndex(plane, view);
    if (cutsMedium(inIndex, medium.cells, volume_.layout.interior)) medium.planes.push_back(inIndex);
  }
  const std::uint64_t most = std::max<std::uint64_t>(scene.bricks.budgetMiB << 20, std::uint64_t{2} << 30);
  const bool computed = light_.update(medium, most);
  if (computed) ++version_;
  ms_ = computed ? watch.elapsedMs() : 0;
}

void ResidentLight::addTo(RenderStats& stats) const {
  stats.directions = light_.stats().directions;
  stats.windowUpdates = light_.stats().updates;
  stats.lightSpacing = light_.stats().spacing;
  stats.lightSpacingError = light_.stats().spacingError;
  stats.windowBytes = textures_.bytes();
  stats.textureBytes += textures_.bytes();
  stats.lightMs = ms_;
}

}  // namespace umbrick
