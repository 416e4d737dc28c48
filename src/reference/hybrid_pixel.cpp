// SPDX-License-Identifier: Apache-2.0
#include "reference/hybrid_pixel.h"

#include "umbrick/scene/capabilities.h"

namespace umbrick {

HybridPixel::HybridPixel(const ValueSpace& surfaces, const ReferenceSpace& medium, const ReferenceOptions& options,
                         double step, double voxelEdge, const GoOn& goOn)
    : space_(medium), surface_(surfaces, medium.places, nullptr), medium_(medium, options, step, voxelEdge, goOn) {}

std::optional<ValueResult> HybridPixel::integrate(int x, int y) {
  const bool lit = traitsOf(space_.scene.model).occlusion;
  ValueMean mean;
  for (const glm::dvec2& place : space_.places) {
    const EyeRays::Ray ray = space_.rays.through(x, y, place);
    const std::optional<MeshEnd> end = space_.mesh ? space_.mesh->find(ray) : std::nullopt;
    std::optional<ValueResult> met = surface_.meet(ray, endOf(end), lit ? &medium_ : nullptr);
    if (!met) return std::nullopt;
    ValueResult& one = *met;
    if (one.first && one.colour.w < 1) {
      const std::optional<PixelResult> behind = medium_.integrate(ray, Interval{*one.first, endOf(end)});
      if (!behind) return std::nullopt;
      const double through = 1 - one.colour.w;
      one.colour += through * glm::dvec4(space_.scene.ambient * behind->light + behind->emitted, behind->opacity);
      one.depth += through * behind->depth;
      one.visibility += through * behind->visibility;
    }
    if (end) layOverMesh(*end, ray, space_.scene.ambient, one);
    mean.add(one);
  }
  return mean.result();
}

RayCounts HybridPixel::counts() const {
  RayCounts counts = surface_.counts();
  counts.add(medium_.counts());
  return counts;
}

}  // namespace umbrick
