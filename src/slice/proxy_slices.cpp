// SPDX-License-Identifier: Apache-2.0
#include "umbrick/slice/proxy_slices.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <utility>

#include "slice/plane_cut.h"
#include "slice/slice_polygons.h"
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

// Returns the slices whose middle is in (nearest corner, farthest corner] and in front of the eye.
SliceInterval slicesThrough(const Corners& corners, double spacing, double phase) {
  double nearest = corners[0].z, farthest = corners[0].z;
  for (const glm::dvec3& corner : corners) {
    nearest = std::min(nearest, corner.z);
    farthest = std::max(farthest, corner.z);
  }
  if (!(farthest > 0)) return {};
  return slicesBetween(nearest, farthest, spacing, phase, 0);
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
        if (polygon.size() >= 3)
          clip(polygon, scratch,
               [&](const glm::dvec2& p) { return plane.x * p.x + plane.y * p.y + (plane.z * depth + plane.w); });
      if (polygon.size() < 3) continue;
      for (glm::dvec2& point : polygon) point *= scale;
      addPolygon(view_, polygon, scratch, brick, out);
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

  const IndexView& view_;
  std::span<const Corners> corners_;
  std::vector<glm::dvec4> planes_;
  std::array<PlaneCut, 256> cuts_;
};

}  // namespace

ProxySlices cutSlices(const IndexView& view, std::span<const glm::ivec3> origins, const glm::ivec3& interior,
                      std::span<const glm::dvec4> viewPlanes, double spacing, double phase, std::int64_t maxSlices) {
  checkSlices(spacing, phase);
  std::vector<Corners> corners(origins.size());
  std::vector<SliceInterval> intervals(origins.size());
  double farthest = 0;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    corners[i] = brickCorners(view, origins[i], interior);
    for (const glm::dvec3& corner : corners[i]) farthest = std::max(farthest, corner.z);
  }
  // The depths are checked before slices are counted, since beyond 2^53 the numbers of slices would not be exact.
  if (farthest / spacing > 9e15)
    throw InvalidArgument("slices: spacing " + std::to_string(spacing) + " is too small for a volume at depth " +
                          std::to_string(farthest));
  for (std::size_t i = 0; i < origins.size(); ++i) intervals[i] = slicesThrough(corners[i], spacing, phase);
  const SliceCutter cutter(view, corners, viewPlanes, spacing);
  ProxySlices slices = cutEach(
      intervals, spacing, phase, maxSlices,
      [&](double depth, std::span<const std::int32_t> bricks, SlicePolygons& out) { cutter.cut(depth, bricks, out); });
  slices.perDepth = view.toIndex[2];
  return slices;
}

}  // namespace umbrick
