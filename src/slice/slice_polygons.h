// What slices across the view and slices of stacks have in common, once it is known where a plane cuts a brick.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <span>
#include <utility>
#include <vector>

#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

using Polygon = std::vector<glm::dvec2>;

/// The polygons of one slice.
struct SlicePolygons {
  std::vector<ProxyPolygon> polygons;
  std::vector<glm::vec2> vertices;
};

/// Slices that a brick may be cut by, both included; none where last < first.
struct SliceInterval {
  std::int64_t first = 0, last = -1;
};

/// @throw InvalidArgument  spacing <= 0 or not finite; phase outside (0, 1)
void checkSlices(double spacing, double phase);

/// Returns the slices whose middle, at (i + phase) spacing, is in (nearest, farthest], from slice `least` on.
SliceInterval slicesBetween(double nearest, double farthest, double spacing, double phase, std::int64_t least);

/// Keeps the part of a convex polygon with distance >= 0 (Sutherland-Hodgman). A crossing is computed from the lesser
/// end of an edge to the greater, so that two polygons that share an edge cut it at the same point.
template <class Point, class Distance>
void clip(std::vector<Point>& polygon, std::vector<Point>& scratch, const Distance& distance) {
  scratch.clear();
  const auto isLess = [](const Point& a, const Point& b) {
    for (int c = 0; c + 1 < Point::length(); ++c)
      if (a[c] != b[c]) return a[c] < b[c];
    return a[Point::length() - 1] < b[Point::length() - 1];
  };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point a = polygon[i], b = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    const double da = distance(a), db = distance(b);
    if (da >= 0) scratch.push_back(a);
    if ((da >= 0) == (db >= 0)) continue;
    const bool ordered = isLess(a, b);
    const Point p = ordered ? a : b, q = ordered ? b : a;
    const double dp = ordered ? da : db, dq = ordered ? db : da;
    scratch.push_back(p + (q - p) * (dp / (dp - dq)));
  }
  std::swap(polygon, scratch);
}

/// Adds a polygon, moved to the grid of kSubpixels, unless it lies outside the image.
/// @param points   screen points over view.halfExtent; at least three
/// @param scratch  anything
void addPolygon(const IndexView& view, const Polygon& points, Polygon& scratch, std::int32_t brick, SlicePolygons& out);

/// Cuts the slices of all intervals, side by side.
/// @param intervals  by brick
/// @param cut        adds the polygons of these bricks, in ascending order, with the slice at a depth
/// @throw InvalidArgument  more than maxSlices, or too many polygons
ProxySlices cutEach(
    std::span<const SliceInterval> intervals, double spacing, double phase, std::int64_t maxSlices,
    const std::function<void(double depth, std::span<const std::int32_t> bricks, SlicePolygons& out)>& cut);

}  // namespace umbrick
