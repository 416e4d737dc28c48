// SPDX-License-Identifier: Apache-2.0
#include "shade/screen_region.h"

#include <algorithm>
#include <cmath>

namespace umbrick {
namespace {

// Linear interpolation reads half a texel farther, and rounding adds a little more.
constexpr double kFilterReach = 1.0;

int toPixel(double x, int size) { return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(size))); }

// A rectangle of pixels as light spreads from it: its core stays sharp, and the variances of the steps add
// up around it.
struct Spread {
  ScreenRegion core;
  double variance = 0, lastRadius = 0;

  // Moves the core to where it is seen from one slice farther back (`inwards`) or one slice nearer.
  void step(const SliceStep& s, bool inwards, const glm::ivec2& size, const glm::dvec2& viewAxis) {
    if (core.empty()) return;
    const double scale = inwards ? 1 / s.scale : s.scale;
    for (int axis = 0; axis < 2; ++axis) {
      const double centre = viewAxis[axis];
      // A read beyond the screen gives its edge, so what touches the edge counts as reaching beyond it without end.
      const bool lowEdge = inwards && core.min[axis] <= 0, highEdge = inwards && core.max[axis] >= size[axis];
      const double low = lowEdge ? 0 : centre + (core.min[axis] - centre) * scale;
      const double high = highEdge ? size[axis] : centre + (core.max[axis] - centre) * scale;
      // The region keeps at least the edge pixel, which stands for all pixels beyond it.
      core.min[axis] = std::min(toPixel(std::floor(low), size[axis]), size[axis] - 1);
      core.max[axis] = std::max(toPixel(std::ceil(high), size[axis]), 1);
    }
    variance = (variance + (inwards ? s.deviation * s.deviation : 0)) * scale * scale +
               (inwards ? 0 : s.deviation * s.deviation);
    lastRadius = s.radius;
  }

  ScreenRegion region(const glm::ivec2& size) const {
    if (core.empty()) return {};
    // The first steps do not add up to a Gaussian yet, so two of them count in full.
    const double reach = kWalkReach * std::sqrt(variance) + 2 * (lastRadius + kFilterReach);
    ScreenRegion grown;
    for (int axis = 0; axis < 2; ++axis) {
      grown.min[axis] = toPixel(std::floor(core.min[axis] - reach), size[axis]);
      grown.max[axis] = toPixel(std::ceil(core.max[axis] + reach), size[axis]);
    }
    return grown;
  }
};

}  // namespace

void ScreenRegion::include(const ScreenRegion& other) {
  if (other.empty()) return;
  if (empty()) {
    *this = other;
    return;
  }
  min = {std::min(min.x, other.min.x), std::min(min.y, other.min.y)};
  max = {std::max(max.x, other.max.x), std::max(max.y, other.max.y)};
}

void ScreenRegion::intersect(const ScreenRegion& other) {
  if (empty() || other.empty()) {
    *this = {};
    return;
  }
  min = {std::max(min.x, other.min.x), std::max(min.y, other.min.y)};
  max = {std::min(max.x, other.max.x), std::min(max.y, other.max.y)};
  if (empty()) *this = {};
}

std::vector<ScreenRegion> occlusionRegions(std::span<const ScreenRegion> covered, std::span<const SliceStep> steps,
                                           const glm::ivec2& size, const glm::dvec2& axis) {
  const std::size_t count = covered.size();
  // Front to back: the pixels that have been darkened so far. A region never shrinks, since a buffer still holds what
  // was written two slices ago.
  std::vector<ScreenRegion> regions(count);
  Spread darkened;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) darkened.step(steps[i], true, size, axis);
    darkened.core.include(covered[i]);
    regions[i] = darkened.region(size);
    if (i > 0) regions[i].include(regions[i - 1]);
  }
  // Back to front: the pixels that later slices read.
  Spread wanted;
  for (std::size_t i = count; i-- > 0;) {
    regions[i].intersect(wanted.region(size));
    wanted.core.include(covered[i]);
    wanted.step(steps[i], false, size, axis);
  }
  return regions;
}

}  // namespace umbrick
