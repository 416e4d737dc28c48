// SPDX-License-Identifier: Apache-2.0
#include "slice/slice_polygons.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <string>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {

// Finds a vertex whose fan of triangles covers the polygon once. Vertices have been moved to a grid, and one that lay
// near the line between its neighbours may now dent the polygon; a fan around another vertex would then cover the dent
// twice. The test is exact, since products of grid coordinates are.
std::size_t fanApex(const Polygon& vertices) {
  const std::size_t count = vertices.size();
  const auto turn = [](const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  };
  for (std::size_t apex = 0; apex < count; ++apex) {
    bool left = false, right = false;
    for (std::size_t i = 1; i + 1 < count; ++i) {
      const double t = turn(vertices[apex], vertices[(apex + i) % count], vertices[(apex + i + 1) % count]);
      left = left || t > 0;
      right = right || t < 0;
    }
    if (!(left && right)) return apex;
  }
  return 0;
}

// The bricks of each slice: those of slice i are list[start[i]] to list[start[i + 1] - 1], in ascending order.
struct Buckets {
  std::vector<std::size_t> start;
  std::vector<std::int32_t> list;
};

Buckets sortBySlice(std::span<const SliceInterval> intervals, std::int64_t first, std::int64_t count) {
  Buckets buckets;
  buckets.start.assign(static_cast<std::size_t>(count) + 1, 0);
  for (const SliceInterval& interval : intervals)
    for (std::int64_t i = interval.first; i <= interval.last; ++i)
      ++buckets.start[static_cast<std::size_t>(i - first) + 1];
  for (std::size_t i = 1; i < buckets.start.size(); ++i) buckets.start[i] += buckets.start[i - 1];
  buckets.list.resize(buckets.start.back());
  std::vector<std::size_t> next(buckets.start.begin(), buckets.start.end() - 1);
  for (std::size_t brick = 0; brick < intervals.size(); ++brick)
    for (std::int64_t i = intervals[brick].first; i <= intervals[brick].last; ++i)
      buckets.list[next[static_cast<std::size_t>(i - first)]++] = static_cast<std::int32_t>(brick);
  return buckets;
}

ProxySlices join(std::vector<SlicePolygons>& slices, std::int64_t first, double spacing, double phase) {
  ProxySlices all;
  all.spacing = spacing;
  all.phase = phase;
  all.first = first;
  std::size_t polygons = 0, vertices = 0;
  for (const SlicePolygons& slice : slices) {
    polygons += slice.polygons.size();
    vertices += slice.vertices.size();
  }
  if (vertices > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw InvalidArgument("slices: " + std::to_string(polygons) +
                          " polygons are too many; use a larger spacing or larger bricks");
  all.polygons.reserve(polygons);
  all.vertices.reserve(vertices);
  for (SlicePolygons& slice : slices) {
    const auto base = static_cast<std::int32_t>(all.vertices.size());
    for (ProxyPolygon polygon : slice.polygons) {
      polygon.firstVertex += base;
      all.polygons.push_back(polygon);
    }
    all.vertices.insert(all.vertices.end(), slice.vertices.begin(), slice.vertices.end());
    all.start.push_back(static_cast<std::int32_t>(all.polygons.size()));
    slice = {};
  }
  return all;
}

}  // namespace

void checkSlices(double spacing, double phase) {
  if (!(spacing > 0) || !std::isfinite(spacing))
    throw InvalidArgument("slices: spacing is " + std::to_string(spacing) + ", must be above 0");
  if (!(phase > 0 && phase < 1))
    throw InvalidArgument("slices: phase is " + std::to_string(phase) + ", must be in (0, 1)");
}

SliceInterval slicesBetween(double nearest, double farthest, double spacing, double phase, std::int64_t least) {
  const auto middle = [&](std::int64_t i) { return (static_cast<double>(i) + phase) * spacing; };
  // Rounding may put the quotient off by one, so the loops step from outside of it to the exact answer.
  std::int64_t first = std::max(least, static_cast<std::int64_t>(std::floor(nearest / spacing - phase)) - 1);
  while (middle(first) <= nearest) ++first;
  std::int64_t last = static_cast<std::int64_t>(std::ceil(farthest / spacing - phase)) + 1;
  while (last >= first && middle(last) > farthest) --last;
  return {first, last};
}

void addPolygon(const IndexView& view, const Polygon& points, Polygon& vertices, std::int32_t brick,
                SlicePolygons& out) {
  // Vertices are moved to the rasteriser's grid, and neighbours that fall on one point become one.
  const glm::dvec2 toGrid = 0.5 * kSubpixels * glm::dvec2(view.size);
  vertices.clear();
  const glm::dvec2 middle = view.centre / view.halfExtent;
  for (const glm::dvec2& point : points) {
    const glm::dvec2 snapped = glm::round(point * toGrid - middle * toGrid);
    if (vertices.empty() || snapped != vertices.back()) vertices.push_back(snapped);
  }
  while (vertices.size() > 1 && vertices.back() == vertices.front()) vertices.pop_back();
  if (vertices.size() < 3) return;

  glm::dvec2 low = vertices[0], high = vertices[0];
  for (const glm::dvec2& vertex : vertices) {
    low = glm::min(low, vertex);
    high = glm::max(high, vertex);
  }
  const bool seen = low.x < toGrid.x && low.y < toGrid.y && high.x > -toGrid.x && high.y > -toGrid.y;
  if (!seen) return;
  const auto count = static_cast<std::int32_t>(vertices.size());
  out.polygons.push_back({brick, static_cast<std::int32_t>(out.vertices.size()), count});
  const std::size_t apex = fanApex(vertices);
  for (std::size_t i = 0; i < vertices.size(); ++i)
    out.vertices.emplace_back(vertices[(apex + i) % vertices.size()] / toGrid);
}
ProxySlices cutEach(
    std::span<const SliceInterval> intervals, double spacing, double phase, std::int64_t maxSlices,
    const std::function<void(double depth, std::span<const std::int32_t> bricks, SlicePolygons& out)>& cut) {
  std::int64_t first = std::numeric_limits<std::int64_t>::max(), last = std::numeric_limits<std::int64_t>::min();
  for (const SliceInterval& interval : intervals) {
    if (interval.last < interval.first) continue;
    first = std::min(first, interval.first);
    last = std::max(last, interval.last);
  }
  ProxySlices none;
  none.spacing = spacing;
  none.phase = phase;
  if (last < first) return none;
  const std::int64_t count = last - first + 1;
  if (count > maxSlices)
    throw InvalidArgument("slices: spacing " + std::to_string(spacing) + " makes " + std::to_string(count) +
                          " slices, at most " + std::to_string(maxSlices) + " are allowed");
  const Buckets buckets = sortBySlice(intervals, first, count);
  std::vector<SlicePolygons> slices(static_cast<std::size_t>(count));
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, slices.size()), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const double depth = (static_cast<double>(first + static_cast<std::int64_t>(i)) + phase) * spacing;
      cut(depth, std::span(buckets.list).subspan(buckets.start[i], buckets.start[i + 1] - buckets.start[i]), slices[i]);
    }
  });
  return join(slices, first, spacing, phase);
}

}  // namespace umbrick
