// SPDX-License-Identifier: Apache-2.0
#include "umbrick/slice/proxy_slices.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <utility>

#include "slice/plane_cut.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

using Corners = std::array<glm::dvec3, 8>;

// Returns the view coordinates of a brick's corners. Each is a sum of one term per axis, monotone in the index along
// it, and every brick adds in the same order. So equal corners get equal numbers, and depth stays monotone along each
// axis when it is rounded.
Corners brickCorners(const IndexView& view, const glm::ivec3& origin, const glm::ivec3& interior) {
  const glm::dvec3 low = glm::dvec3(origin) - 0.5;
  const glm::dvec3 high = glm::dvec3(origin) + glm::dvec3(interior) - 0.5;
  const glm::dvec3 x[2] = {view.axis[0] * low.x, view.axis[0] * high.x};
  const glm::dvec3 y[2] = {view.axis[1] * low.y, view.axis[1] * high.y};
  const glm::dvec3 z[2] = {view.axis[2] * low.z, view.axis[2] * high.z};
  Corners corners;
  for (unsigned c = 0; c < 8; ++c) corners[c] = ((x[c & 1] + y[c >> 1 & 1]) + z[c >> 2 & 1]) + view.origin;
  return corners;
}

struct SliceInterval {
  std::int64_t first = 0, last = -1;  // both included
};

// Returns the slices whose middle is in (nearest corner, farthest corner] and in front of the eye.
SliceInterval slicesThrough(const Corners& corners, double spacing, double phase) {
  double nearest = corners[0].z, farthest = corners[0].z;
  for (const glm::dvec3& corner : corners) {
    nearest = std::min(nearest, corner.z);
    farthest = std::max(farthest, corner.z);
  }
  if (!(farthest > 0)) return {};
  const auto middle = [&](std::int64_t i) { return (static_cast<double>(i) + phase) * spacing; };
  // Rounding may put the quotient off by one, so the loops step from outside of it to the exact answer.
  std::int64_t first = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::floor(nearest / spacing - phase)) - 1);
  while (middle(first) <= nearest) ++first;
  std::int64_t last = static_cast<std::int64_t>(std::ceil(farthest / spacing - phase)) + 1;
  while (last >= first && middle(last) > farthest) --last;
  return {first, last};
}

using Polygon = std::vector<glm::dvec2>;

// Keeps the part with distance >= 0 (Sutherland-Hodgman). A crossing is computed from the lesser end of an edge to the
// greater, so that two polygons that share an edge cut it at the same point.
void clip(Polygon& polygon, Polygon& scratch, const glm::dvec3& line) {
  scratch.clear();
  const auto distance = [&](const glm::dvec2& p) { return line.x * p.x + line.y * p.y + line.z; };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 a = polygon[i], b = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    const double da = distance(a), db = distance(b);
    if (da >= 0) scratch.push_back(a);
    if ((da >= 0) != (db >= 0)) {
      const bool ordered = a.x < b.x || (a.x == b.x && a.y < b.y);
      const glm::dvec2 p = ordered ? a : b, q = ordered ? b : a;
      const double dp = ordered ? da : db, dq = ordered ? db : da;
      scratch.push_back(p + (q - p) * (dp / (dp - dq)));
    }
  }
  std::swap(polygon, scratch);
}

// Moves a plane outwards by as much as the middle of a slab may lie beyond it while the slab still reaches the kept
// side, and by kPlaneMargin pixels, since the rasteriser moves vertices.
glm::dvec4 widened(glm::dvec4 plane, const IndexView& view, double spacing) {
  const glm::dvec2 across = glm::abs(glm::dvec2(plane));
  const double margin = kPlaneMargin * 2 * view.halfExtent.y / view.size.y * glm::length(across);
  if (view.projection == Projection::perspective) {
    const glm::dvec2 reach = view.halfExtent + glm::abs(view.centre);
    plane.w += 0.5 * spacing * (std::abs(plane.z) + across.x * reach.x + across.y * reach.y + margin);
    plane.z += margin;  // in world units, a pixel grows with depth
  } else {
    plane.w += 0.5 * spacing * std::abs(plane.z) + margin;
  }
  return plane;
}

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

struct SlicePolygons {
  std::vector<ProxyPolygon> polygons;
  std::vector<glm::vec2> vertices;
};

// Cuts the bricks of one slice.
class SliceCutter {
 public:
  SliceCutter(const IndexView& view, std::span<const Corners> corners, std::span<const glm::dvec4> planes,
              double spacing)
      : view_(view), corners_(corners), planes_(planes.begin(), planes.end()), cuts_(planeCuts()) {
    for (glm::dvec4& plane : planes_) plane = widened(plane, view, spacing);
  }

  void cut(double depth, std::span<const std::int32_t> bricks, SlicePolygons& out) const {
    Polygon polygon, scratch;
    const glm::dvec2 scale =
        1.0 / (view_.halfExtent * (view_.projection == Projection::perspective ? depth : 1.0));  // view to device
    for (const std::int32_t brick : bricks) {
      const Corners& corners = corners_[static_cast<std::size_t>(brick)];
      crossSection(corners, depth, polygon);
      for (const glm::dvec4& plane : planes_)
        if (polygon.size() >= 3) clip(polygon, scratch, {plane.x, plane.y, plane.z * depth + plane.w});
      if (polygon.size() < 3) continue;
      emit(polygon, scratch, scale, view_.centre / view_.halfExtent, brick, out);
    }
  }

 private:
  void crossSection(const Corners& corners, double depth, Polygon& polygon) const {
    unsigned mask = 0;
    for (unsigned c = 0; c < 8; ++c) mask |= static_cast<unsigned>(corners[c].z >= depth) << c;
    const PlaneCut& cut = cuts_[mask];
    polygon.clear();
    for (unsigned i = 0; i < cut.count; ++i) {
      const auto [lower, upper] = kEdgeCorners[cut.edges[i]];
      const glm::dvec3 &a = corners[lower], &b = corners[upper];
      const double t = (depth - a.z) / (b.z - a.z);
      polygon.push_back(glm::dvec2(a) + (glm::dvec2(b) - glm::dvec2(a)) * t);
    }
  }

  // @param scale,middle  of view coordinates to device coordinates
  void emit(const Polygon& polygon, Polygon& vertices, const glm::dvec2& scale, const glm::dvec2& middle,
            std::int32_t brick, SlicePolygons& out) const {
    // Vertices are moved to the rasteriser's grid, and neighbours that fall on one point become one.
    const glm::dvec2 toGrid = 0.5 * kSubpixels * glm::dvec2(view_.size);
    vertices.clear();
    for (const glm::dvec2& point : polygon) {
      const glm::dvec2 snapped = glm::round(point * scale * toGrid - middle * toGrid);
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

  const IndexView& view_;
  std::span<const Corners> corners_;
  std::vector<glm::dvec4> planes_;
  std::array<PlaneCut, 256> cuts_;
};

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

ProxySlices cutSlices(const IndexView& view, std::span<const glm::ivec3> origins, const glm::ivec3& interior,
                      std::span<const glm::dvec4> viewPlanes, double spacing, double phase, std::int64_t maxSlices) {
  if (!(spacing > 0) || !std::isfinite(spacing))
    throw InvalidArgument("slices: spacing is " + std::to_string(spacing) + ", must be above 0");
  if (!(phase > 0 && phase < 1))
    throw InvalidArgument("slices: phase is " + std::to_string(phase) + ", must be in (0, 1)");
  std::vector<Corners> corners(origins.size());
  std::vector<SliceInterval> intervals(origins.size());
  std::int64_t first = std::numeric_limits<std::int64_t>::max(), last = -1;
  double farthest = 0;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    corners[i] = brickCorners(view, origins[i], interior);
    for (const glm::dvec3& corner : corners[i]) farthest = std::max(farthest, corner.z);
  }
  // The depths are checked before slices are counted, since beyond 2^53 the numbers of slices would not be exact.
  if (farthest / spacing > 9e15)
    throw InvalidArgument("slices: spacing " + std::to_string(spacing) + " is too small for a volume at depth " +
                          std::to_string(farthest));
  for (std::size_t i = 0; i < origins.size(); ++i) {
    intervals[i] = slicesThrough(corners[i], spacing, phase);
    if (intervals[i].last < intervals[i].first) continue;
    first = std::min(first, intervals[i].first);
    last = std::max(last, intervals[i].last);
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
  const SliceCutter cutter(view, corners, viewPlanes, spacing);
  std::vector<SlicePolygons> slices(static_cast<std::size_t>(count));
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, slices.size()), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const double depth = (static_cast<double>(first + static_cast<std::int64_t>(i)) + phase) * spacing;
      cutter.cut(depth, std::span(buckets.list).subspan(buckets.start[i], buckets.start[i + 1] - buckets.start[i]),
                 slices[i]);
    }
  });
  return join(slices, first, spacing, phase);
}

}  // namespace umbrick
