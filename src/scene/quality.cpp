// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "umbrick/scene/scene.h"

namespace umbrick {
namespace {

struct QualityRow {
  Quality quality;
  Method method;
  double spacing;  // voxels
  int segments, directions;
};
// The segments of `draft` have twice the usual length.
constexpr QualityRow kQualityRows[]{{Quality::draft, Method::ordinates, 5, 4, 6},
                                    {Quality::normal, Method::lightVolume, 2.5, 4, 16},
                                    {Quality::high, Method::lightVolume, 1.25, 2, 32}};

}  // namespace

int segmentsOf(double slabVoxels) {
  // A slab of exactly one segment's length is one segment, even where rounding makes it a little longer.
  return std::clamp(static_cast<int>(std::ceil(slabVoxels / kSegmentVoxels - 1e-9)), 1, kMostSegments);
}

void applyQuality(Quality quality, Scene& scene) {
  const QualityRow& row = *std::find_if(std::begin(kQualityRows), std::end(kQualityRows),
                                        [&](const QualityRow& candidate) { return candidate.quality == quality; });
  scene.spacingUnit = SpacingUnit::voxel;
  scene.sampling.spacing = row.spacing;
  scene.sampling.segments = row.segments;
  scene.method = row.method;
  scene.occlusion.ordinates = {.directions = row.directions, .scale = 0};
}

}  // namespace umbrick
