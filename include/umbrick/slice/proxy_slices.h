// View-aligned proxy slices: where each slice plane cuts each brick, as polygons in the image.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "umbrick/core/camera.h"

namespace umbrick {

/// Index space as the camera sees it. View coordinates are (along right, along up, depth) from the eye, world units:
/// those of index point (i, j, k) are origin + i axis[0] + j axis[1] + k axis[2].
struct IndexView {
  std::array<glm::dvec3, 3> axis;
  glm::dvec3 origin;
  Projection projection = Projection::perspective;
  glm::dvec2 halfExtent;  // of the screen plane, see screenPlane
  glm::ivec2 size;        // of the image, pixels

  glm::dvec3 toView(const glm::dvec3& index) const;
  /// Change of index coordinates along the view axes: toIndex[0] for one unit to the right, [1] up, [2] forward.
  std::array<glm::dvec3, 3> toIndex;
  glm::dvec3 eyeIndex;  // the eye, index coordinates
};

/// @throw InvalidArgument  a transform that cannot be inverted, or as cameraFrame
IndexView indexView(const Camera& camera, const glm::dmat4& indexToWorld);

/// A half-space as the camera sees it: keeps dot(xyz, view coordinates) + w >= 0.
glm::dvec4 planeInView(const glm::dvec4& worldPlane, const Camera& camera);

/// How far a slab of thickness `spacing` reaches from its middle along a view ray, at most over the image, along each
/// index axis, in voxels.
glm::dvec3 slabReach(const IndexView& view, double spacing);

/// Steps of a rasteriser's grid along the edge of a pixel: 8 bits in Mesa's software drivers and in current hardware.
inline constexpr int kSubpixels = 256;

/// Pixels by which polygons reach beyond a plane that cuts them: shaders cut slabs exactly, so that a polygon may be
/// too large but not too small.
inline constexpr double kPlaneMargin = 1.0 / 64;

struct ProxyPolygon {
  std::int32_t brick;  // position in the list of bricks
  std::int32_t firstVertex;
  std::int32_t vertices;  // 3 or more, in order, to be drawn as a fan around the first
};

/// Slices first, first + 1, ... with the polygons of each. The middle of slice i is at depth (i + phase) spacing from
/// the eye, one phase for all bricks, so that a slice moves with the camera and not with a brick.
struct ProxySlices {
  double spacing = 0;  // world units
  double phase = 0.5;
  std::int64_t first = 0;
  std::vector<std::int32_t> start{0};  // polygons of slice first + i are [start[i], start[i + 1])
  std::vector<ProxyPolygon> polygons;  // within a slice in order of the bricks
  std::vector<glm::vec2> vertices;     // normalised device coordinates
  std::int64_t count() const { return static_cast<std::int64_t>(start.size()) - 1; }
  double depth(std::int64_t i) const { return (static_cast<double>(first + i) + phase) * spacing; }
};

/// Where slices cut bricks of one size.
///
/// Each point of a slice inside the bricks lies in exactly one polygon: neighbouring bricks compute a shared vertex
/// from the same numbers in the same order, a corner on the plane counts as behind it for all, and a corner's depth is
/// a sum of one monotone term per axis, so that rounding cannot tear a cut into two. Needs a compiler that does not
/// contract or reorder floating point. Vertices are moved to the grid of kSubpixels that rasterisers move them to
/// anyway, and a polygon starts at a vertex from which its fan of triangles covers it once even where that has dented
/// it.
///
/// @param origins    first owned voxel of each brick
/// @param interior   owned voxels along each axis; a brick fills [origin - 1/2, origin + interior - 1/2)
/// @param viewPlanes half-spaces (see planeInView) beyond which nothing is drawn; what is left of a slab that a plane
/// cuts
///                   stays, so polygons reach half a slab and kPlaneMargin beyond it
/// @param phase      in (0, 1): 1/2 has the first slab begin at the eye
/// @return slices between the nearest and the farthest that anything crosses; polygons outside the image are left out
/// @throw InvalidArgument  spacing <= 0 or so small that there would be more than `maxSlices`
ProxySlices cutSlices(const IndexView& view, std::span<const glm::ivec3> origins, const glm::ivec3& interior,
                      std::span<const glm::dvec4> viewPlanes, double spacing, double phase = 0.5,
                      std::int64_t maxSlices = 1'000'000);

}  // namespace umbrick
