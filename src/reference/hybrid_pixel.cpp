// SPDX-License-Identifier: Apache-2.0
#include "reference/hybrid_pixel.h"

namespace umbrick {

HybridPixel::HybridPixel(const ValueSpace& surfaces, const ReferenceSpace& medium, const ReferenceOptions& options,
                         double step, double voxelEdge, const GoOn& goOn)
    : space_(medium), surface_(surfaces, medium.places), medium_(medium, options, step, voxelEdge, goOn) {}

std::optional<HybridResult> HybridPixel::integrate(int x, int y) {
  HybridResult result;
  ValueMean mean;
  for (const glm::dvec2& place : space_.places) {
    const EyeRays::Ray ray = space_.rays.through(x, y, place);
    ValueResult one = surface_.meet(ray);
    double visibility = one.colour.w;
    if (one.first && one.colour.w < 1) {
      const std::optional<PixelResult> behind = medium_.integrate(ray, *one.first);
      if (!behind) return std::nullopt;
      const double through = 1 - one.colour.w;
      one.colour += through * glm::dvec4(space_.scene.ambient * behind->light, behind->opacity);
      one.depth += through * behind->depth;
      visibility += through * behind->visibility;
    }
    mean.add(one);
    result.visibility += visibility / static_cast<double>(space_.places.size());
  }
  result.surface = mean.result();
  return result;
}

RayCounts HybridPixel::counts() const {
  RayCounts counts = surface_.counts();
  counts.add(medium_.counts());
  return counts;
}

}  // namespace umbrick
