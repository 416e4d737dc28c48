// What slices across the view and slices of stacks have in common, once it is known where a plane cuts a brick.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <span>
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
