// What of the light's windows a sweep needs, worked out before anything is drawn.
#pragma once
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

/// An axis-parallel rectangle on a slice; empty when some max <= min.
struct Rectangle {
  glm::dvec2 min{std::numeric_limits<double>::infinity()}, max{-std::numeric_limits<double>::infinity()};
  bool empty() const { return !(max.x > min.x && max.y > min.y); }
  void include(const Rectangle& other);
  Rectangle within(const Rectangle& other) const;
  Rectangle grown(double by) const;
  Rectangle moved(const glm::dvec2& by) const { return {min + by, max + by}; }
};

/// A direction of the light as the slices see it.
struct LightSlope {
  glm::dvec2 slope;    // change across per depth on the way to the light, against the view direction
  double stretch = 1;  // length per depth: 1 / cos(angle to the view axis)
};
/// @param towards  unit length, along (right, up, towards the viewer), the last above 0; less than 1e-6 counts as that,
/// so that numbers of texels stay exact
LightSlope lightSlope(const glm::dvec3& towards);

/// The grid of points at which light is known on every slice: texel (i, j) covers
/// [first + shift + (i, j), first + shift + (i + 1, j + 1)] * texel in view coordinates. One grid for all slices,
/// aligned with the view axis, so that it does not depend on which bricks there are.
struct LightLattice {
  double texel = 1;     // edge, world units
  glm::dvec2 shift{0};  // texels
  glm::ivec2 first{0}, size{0};
  glm::dvec2 offset() const { return shift * texel; }
  glm::dvec2 centre() const { return (glm::dvec2(first) + shift + 0.5 * glm::dvec2(size)) * texel; }
};

/// The window of one direction while it passes a run of slices: texels [first, first + size) of its own endless plane.
struct LightWindow {
  glm::vec<2, std::int64_t> first{0};  // grows with the depth times the slope
  glm::ivec2 size{0};
};

/// Slices that are lit together, with what each direction needs for them.
struct LightRun {
  std::vector<std::int64_t> slices;  // those with bricks, ascending
  std::vector<LightWindow> windows;  // by direction
};

/// Rectangles of slices in texels, relative to the view axis.
struct LightExtents {
  double texel = 1;                  // edge, world units
  std::vector<double> depths;        // of all slices, ascending
  std::vector<Rectangle> seen;       // by slice: where bricks are visible to the eye
  std::vector<Rectangle> occluding;  // by slice: where bricks may occlude
};

/// By slice, the rectangle from which light can still be blocked on its way to something seen on that slice or a later
/// one.
std::vector<Rectangle> neededRegions(const LightExtents& extents, std::span<const LightSlope> slopes);

/// Cuts slices [first, last) into runs of at most `longest` slices, fewer where the windows would get larger than
/// `most` texels each. A window holds the paths that something has touched until the end of the run and that something
/// seen in it or later reads: others are 1 or not asked for. @pre extents hold all slices of the picture
class LightPlanner {
 public:
  LightPlanner(const LightExtents& extents, std::span<const LightSlope> slopes);
  std::vector<LightRun> runs(std::int64_t first, std::int64_t last, int longest, double most) const;

 private:
  LightWindow window(std::size_t direction, std::int64_t first, std::int64_t last) const;
  std::size_t at(std::size_t direction, std::int64_t slice) const {
    return direction * extents_.depths.size() + static_cast<std::size_t>(slice);
  }
  const LightExtents& extents_;
  std::vector<LightSlope> slopes_;
  std::vector<Rectangle> readFrom_, touchedUntil_;  // by direction and slice, in texels of the window's plane
};

/// Calls visit(rectangle) for each polygon of slice i, in units of `texel`. @param centre  of the view, view
/// coordinates
template <class Visit>
void forEachPolygon(const ProxySlices& slices, std::int64_t i, const IndexView& view, const glm::dvec2& centre,
                    double texel, const Visit& visit) {
  const double scale = view.projection == Projection::perspective ? slices.depth(i) : 1.0;
  for (std::int32_t p = slices.start[static_cast<std::size_t>(i)]; p < slices.start[static_cast<std::size_t>(i) + 1];
       ++p) {
    const ProxyPolygon& polygon = slices.polygons[static_cast<std::size_t>(p)];
    Rectangle extent;
    for (std::int32_t v = 0; v < polygon.vertices; ++v) {
      const glm::dvec2 device(slices.vertices[static_cast<std::size_t>(polygon.firstVertex + v)]);
      const glm::dvec2 point = (glm::clamp(device, -1.0, 1.0) * view.halfExtent * scale + centre) / texel;
      extent.min = glm::min(extent.min, point);
      extent.max = glm::max(extent.max, point);
    }
    visit(extent);
  }
}

/// Rectangle of each slice's polygons.
std::vector<Rectangle> polygonExtents(const ProxySlices& slices, const IndexView& view, const glm::dvec2& centre,
                                      double texel);

}  // namespace umbrick
