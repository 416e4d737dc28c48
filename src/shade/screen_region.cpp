#include "shade/screen_region.h"

#include <algorithm>
#include <cmath>

namespace umbrick {
namespace {

// Linear interpolation reads half a texel further, rounding a little more.
constexpr double kFilterReach = 1.0;

int toPixel(double x, int size) { return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(size))); }

// Pixels of a slice that read something of `region` of the slice before.
ScreenRegion readersOf(const ScreenRegion& region, const SliceStep& step, const glm::ivec2& size) {
  if (region.empty()) return {};
  ScreenRegion readers;
  for (int axis = 0; axis < 2; ++axis) {
    const double centre = 0.5 * size[axis], reach = step.radius + kFilterReach;
    // A read beyond the screen gives its edge: what touches the edge is read from all the way out.
    const double low = region.min[axis] <= 0 ? 0 : centre + (region.min[axis] - reach - centre) / step.scale;
    const double high =
        region.max[axis] >= size[axis] ? size[axis] : centre + (region.max[axis] + reach - centre) / step.scale;
    readers.min[axis] = toPixel(std::floor(low), size[axis]);
    readers.max[axis] = toPixel(std::ceil(high), size[axis]);
  }
  return readers;
}

// Pixels of the slice before that `region` of a slice reads.
ScreenRegion readBy(const ScreenRegion& region, const SliceStep& step, const glm::ivec2& size) {
  if (region.empty()) return {};
  ScreenRegion read;
  for (int axis = 0; axis < 2; ++axis) {
    const double centre = 0.5 * size[axis], reach = step.radius + kFilterReach;
    const double low = centre + (region.min[axis] - centre) * step.scale - reach;
    const double high = centre + (region.max[axis] - centre) * step.scale + reach;
    // At least the edge pixel, which stands for all beyond it.
    read.min[axis] = std::min(toPixel(std::floor(low), size[axis]), size[axis] - 1);
    read.max[axis] = std::max(toPixel(std::ceil(high), size[axis]), 1);
  }
  return read;
}

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
                                           const glm::ivec2& size) {
  const std::size_t count = covered.size();
  // Forwards: what has been darkened so far. It never shrinks, since a buffer still holds what was written two slices
  // ago.
  std::vector<ScreenRegion> regions(count);
  ScreenRegion darkened;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) darkened.include(readersOf(darkened, steps[i], size));
    darkened.include(covered[i]);
    regions[i] = darkened;
  }
  // Backwards: what later slices look at.
  ScreenRegion wanted;
  for (std::size_t i = count; i-- > 0;) {
    regions[i].intersect(wanted);
    ScreenRegion readers = covered[i];
    readers.include(wanted);
    wanted = readBy(readers, steps[i], size);
  }
  return regions;
}

}  // namespace umbrick
