// SPDX-License-Identifier: Apache-2.0
#include "umbrick/slice/stack_slices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "slice/slice_polygons.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

// How index coordinate `axis` changes with view coordinates.
glm::dvec3 rateOf(const IndexView& view, int axis) {
  return {view.toIndex[0][axis], view.toIndex[1][axis], view.toIndex[2][axis]};
}

// Returns the part of the image whose rays run along an axis more than along the others, screen points; no more than
// two where there is none. Rays p have dot(rate, (p, 1)) > 0.
Polygon partOf(const IndexView& view, int axis, int sign) {
  const glm::dvec2 low = view.centre - view.halfExtent, high = view.centre + view.halfExtent;
  Polygon part{low, {high.x, low.y}, high, {low.x, high.y}}, scratch;
  const glm::dvec3 rate = static_cast<double>(sign) * rateOf(view, axis);
  const auto keep = [&](const glm::dvec3& line) {
    clip(part, scratch, [&](const glm::dvec2& p) { return line.x * p.x + line.y * p.y + line.z; });
  };
  for (int other = 0; other < 3; ++other)
    if (other != axis)
      for (const double side : {-1.0, 1.0}) keep(rate + side * rateOf(view, other));
  return part;
}

double areaOf(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const glm::dvec2 a = polygon[i - 1] - polygon[0], b = polygon[i] - polygon[0];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * std::abs(twice);
}

double fractionOf(double value) { return value - std::floor(value); }

void setSpacing(StackAim& aim, const IndexView& view, double spacing, double phase) {
  const bool perspective = view.projection == Projection::perspective;
  if (spacing > 0) {
    const glm::dvec3 ray(perspective ? aim.point : glm::dvec2(0), 1);
    aim.spacing = spacing * glm::dot(aim.rate, ray) / glm::length(ray);
    aim.phase = phase;
    return;
  }
  // Slices have whole index coordinates.
  aim.spacing = 1;
  aim.phase = fractionOf(-aim.sign * view.eyeIndex[aim.axis]);
  if (aim.phase == 0) aim.phase = 1;
}

// Cuts the bricks of one slice.
class StackCutter {
 public:
  StackCutter(const IndexView& view, const StackAim& aim, std::span<const glm::ivec3> origins,
              const glm::ivec3& interior, std::span<const glm::dvec4> planes)
      : view_(view), aim_(aim), origins_(origins), interior_(interior) {
    const bool perspective = view.projection == Projection::perspective;
    const double pixel = kPlaneMargin * 2 * view.halfExtent.y / view.size.y;
    const auto add = [&](glm::dvec4 plane, double slabs) {
      // A slab reaches half a spacing along the axis from its middle, and no farther along the other two.
      const glm::dvec3 n(plane);
      double steps = 0;
      for (const glm::dvec3& axis : view.axis) steps += std::abs(glm::dot(n, axis));
      const double margin = pixel * glm::length(glm::dvec2(plane));
      plane.w += slabs * 0.5 * aim.spacing * steps;
      (perspective ? plane.z : plane.w) += margin;  // in world units, a pixel grows with depth
      planes_.push_back(plane);
    };
    for (const glm::dvec4& plane : planes) add(plane, 1);
    if (!aim.alone)
      for (int other = 0; other < 3; ++other)
        if (other != aim.axis)
          for (const double side : {-1.0, 1.0}) add({aim.rate + side * rateOf(view, other), 0}, 0);
    if (!perspective) return;
    for (const double x : {-1.0, 1.0})
      for (const double y : {-1.0, 1.0})
        fastest_ =
            std::max(fastest_, glm::dot(aim.rate, glm::dvec3(view.centre + view.halfExtent * glm::dvec2(x, y), 1)));
  }

  void cut(double depth, std::span<const std::int32_t> bricks, SlicePolygons& out) const {
    const double index = view_.eyeIndex[aim_.axis] + aim_.sign * depth;
    const bool perspective = view_.projection == Projection::perspective;
    std::vector<glm::dvec3> polygon, scratch;
    Polygon points, vertices;
    const auto keep = [&](const glm::dvec4& plane) {
      if (polygon.size() < 3) return;
      clip(polygon, scratch, [&](const glm::dvec3& p) { return glm::dot(glm::dvec3(plane), p) + plane.w; });
    };
    for (const std::int32_t brick : bricks) {
      rectangle(origins_[static_cast<std::size_t>(brick)], index, polygon);
      // Nothing that the image shows of this slice is nearer.
      if (perspective) keep({0, 0, 1, -0.5 * depth / fastest_});
      for (const glm::dvec4& plane : planes_) keep(plane);
      if (polygon.size() < 3) continue;
      points.clear();
      for (const glm::dvec3& p : polygon)
        points.push_back(glm::dvec2(p) / (view_.halfExtent * (perspective ? p.z : 1.0)));
      addPolygon(view_, points, vertices, brick, out);
    }
  }

 private:
  // The cut of a brick, view coordinates. Neighbours compute shared corners from the same numbers in the same order.
  void rectangle(const glm::ivec3& origin, double index, std::vector<glm::dvec3>& polygon) const {
    const int u = (aim_.axis + 1) % 3, v = (aim_.axis + 2) % 3;
    polygon.clear();
    for (const glm::ivec2 corner : {glm::ivec2(0, 0), glm::ivec2(1, 0), glm::ivec2(1, 1), glm::ivec2(0, 1)}) {
      glm::dvec3 place;
      place[aim_.axis] = index;
      place[u] = origin[u] + corner.x * interior_[u] - 0.5;
      place[v] = origin[v] + corner.y * interior_[v] - 0.5;
      polygon.push_back(view_.toView(place));
    }
  }

  const IndexView& view_;
  const StackAim& aim_;
  std::span<const glm::ivec3> origins_;
  glm::ivec3 interior_;
  std::vector<glm::dvec4> planes_;
  double fastest_ = 0;  // the most that depth grows with view depth, over the image
};

}  // namespace

std::vector<StackAim> aimStacks(const IndexView& view, double spacing, double phase) {
  std::vector<StackAim> stacks;
  if (view.projection == Projection::orthographic) {
    StackAim aim;
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs(view.toIndex[2][axis]) > std::abs(view.toIndex[2][aim.axis])) aim.axis = axis;
    aim.sign = view.toIndex[2][aim.axis] > 0 ? 1 : -1;
    aim.rate = static_cast<double>(aim.sign) * rateOf(view, aim.axis);
    setSpacing(aim, view, spacing, phase);
    return {aim};
  }
  // Parts that are smaller than this share of a pixel hold the centre of none.
  const double least = 1e-9 * 4 * view.halfExtent.x * view.halfExtent.y / (double(view.size.x) * view.size.y);
  for (int axis = 0; axis < 3; ++axis)
    for (const int sign : {-1, 1}) {
      const Polygon part = partOf(view, axis, sign);
      if (part.size() < 3 || !(areaOf(part) > least)) continue;
      StackAim aim{axis, sign};
      aim.rate = static_cast<double>(sign) * rateOf(view, axis);
      for (const glm::dvec2& corner : part) aim.point += corner / static_cast<double>(part.size());
      setSpacing(aim, view, spacing, phase);
      stacks.push_back(aim);
    }
  for (StackAim& aim : stacks) aim.alone = stacks.size() == 1;
  return stacks;
}

ProxySlices cutStack(const IndexView& view, const StackAim& aim, std::span<const glm::ivec3> origins,
                     const glm::ivec3& interior, std::span<const glm::dvec4> viewPlanes, std::int64_t maxSlices) {
  checkSlices(aim.spacing, std::min(aim.phase, 0.5));
  const bool perspective = view.projection == Projection::perspective;
  const auto depthOf = [&](double index) { return aim.sign * (index - view.eyeIndex[aim.axis]); };
  std::vector<SliceInterval> intervals(origins.size());
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const double a = depthOf(origins[i][aim.axis] - 0.5);
    const double b = depthOf(origins[i][aim.axis] + interior[aim.axis] - 0.5);
    const double nearest = std::min(a, b), farthest = std::max(a, b);
    if (std::max(std::abs(nearest), std::abs(farthest)) / aim.spacing > 9e15)
      throw InvalidArgument("slices: spacing " + std::to_string(aim.spacing) +
                            " voxels is too small for a volume at depth " + std::to_string(farthest));
    // Under perspective nothing is seen behind the eye.
    const std::int64_t least = perspective ? 0 : std::numeric_limits<std::int64_t>::min();
    intervals[i] = slicesBetween(nearest, farthest, aim.spacing, aim.phase, least);
  }
  const StackCutter cutter(view, aim, origins, interior, viewPlanes);
  ProxySlices slices = cutEach(
      intervals, aim.spacing, aim.phase, maxSlices,
      [&](double depth, std::span<const std::int32_t> bricks, SlicePolygons& out) { cutter.cut(depth, bricks, out); });
  const glm::dvec3 ray(perspective ? aim.point : glm::dvec2(0), 1);
  const glm::dvec3 inIndex = ray.x * view.toIndex[0] + ray.y * view.toIndex[1] + view.toIndex[2];
  slices.perDepth = inIndex / glm::dot(aim.rate, ray);
  return slices;
}

}  // namespace umbrick
