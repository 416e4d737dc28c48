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

/// Index space as the camera sees it. View coordinates are (along right, along up, depth) from the eye, in world units.
/// The point (i, j, k) of index space has the view coordinates origin + i axis[0] + j axis[1] + k axis[2].
struct IndexView {
  std::array<glm::dvec3, 3> axis;
  glm::dvec3 origin;
  Projection projection = Projection::perspective;
  glm::dvec2 halfExtent;  // half the size of the screen plane, see screenPlane
  glm::ivec2 size;        // of the image, pixels
  glm::dvec2 centre{0};   // screen point in the middle of the image; where it is not 0 the image plane is shifted

  /// Returns where the view axis crosses the image, pixels.
  glm::dvec2 axisPixel() const { return (halfExtent - centre) / (2.0 * halfExtent) * glm::dvec2(size); }
  /// Shifts the image plane so that pixels are seen through another place in them. @param place  in [0, 1]^2; 1/2:
  /// centre
  void seeThrough(const glm::dvec2& place) { centre = (place - 0.5) * (2.0 * halfExtent / glm::dvec2(size)); }

  glm::dvec3 toView(const glm::dvec3& index) const;
  /// How index coordinates change along the view axes: toIndex[0] is for one world unit to the right, [1] up,
  /// [2] forward.
  std::array<glm::dvec3, 3> toIndex;
  glm::dvec3 eyeIndex;  // place of the eye in index coordinates
};

/// @throw InvalidArgument  the transform cannot be inverted, or the camera is one that cameraFrame refuses
IndexView indexView(const Camera& camera, const glm::dmat4& indexToWorld);

/// Returns a half-space as the camera sees it: it keeps the points with dot(xyz, view coordinates) + w >= 0.
glm::dvec4 planeInView(const glm::dvec4& worldPlane, const Camera& camera);

/// Returns how far a slab of thickness `spacing` reaches from its middle along a view ray: in voxels along each index
/// axis, for the ray of the image that is longest in the slab.
glm::dvec3 slabReach(const IndexView& view, double spacing);

/// A rasteriser moves vertices to a grid with so many steps along the edge of a pixel: 8 bits in Mesa's software
/// drivers and in current hardware.
inline constexpr int kSubpixels = 256;

/// Polygons reach this many pixels beyond a plane that cuts them. Shaders cut slabs exactly, so a polygon may be too
/// large but not too small.
inline constexpr double kPlaneMargin = 1.0 / 64;

struct ProxyPolygon {
  std::int32_t brick;  // position in the list of bricks
  std::int32_t firstVertex;
  std::int32_t vertices;  // 3 or more, in order; they are drawn as a fan around the first
};

/// The polygons of the slices first, first + 1, and so on. The middle of slice i is at depth (i + phase) spacing from
/// the eye. All bricks share one phase, so that a slice moves with the camera and not with a brick.
struct ProxySlices {
  double spacing = 0;  // world units
  double phase = 0.5;
  std::int64_t first = 0;
  /// How the point of a slice that it is looked up at moves with depth, index coordinates: at depth 0 it is the eye.
  glm::dvec3 perDepth{0};
  std::vector<std::int32_t> start{0};  // polygons of slice first + i are [start[i], start[i + 1])
  std::vector<ProxyPolygon> polygons;  // those of one slice are in the order of the bricks
  std::vector<glm::vec2> vertices;     // in normalised device coordinates
  std::int64_t count() const { return static_cast<std::int64_t>(start.size()) - 1; }
  double depth(std::int64_t i) const { return (static_cast<double>(first + i) + phase) * spacing; }
};

/// Cuts bricks of one size by slices.
///
/// Each point of a slice inside the bricks lies in exactly one polygon. For this, neighbouring bricks compute a shared
/// vertex from the same numbers in the same order; a corner on the plane counts as behind it for all of them; and a
/// corner's depth is a sum of one monotone term per axis, so that rounding cannot tear a cut into two. The compiler
/// must neither contract nor reorder floating point operations. Vertices are moved to the grid of kSubpixels to which
/// rasterisers move them anyway. This may dent a polygon, so each polygon starts at a vertex from which its fan of
/// triangles still covers it once.
///
/// @param origins     first owned voxel of each brick
/// @param interior    owned voxels along each axis; a brick fills [origin - 1/2, origin + interior - 1/2)
/// @param viewPlanes  half-spaces (see planeInView) beyond which nothing is drawn. The rest of a slab that a plane cuts
///                    stays, so polygons reach half a slab and kPlaneMargin beyond the plane.
/// @param phase       in (0, 1); with 1/2 the first slab begins at the eye
/// @return the slices between the nearest and the farthest that cross a brick; polygons outside the image are left out
/// @throw InvalidArgument  phase outside (0, 1), or spacing <= 0 or so small that there would be more than `maxSlices`
ProxySlices cutSlices(const IndexView& view, std::span<const glm::ivec3> origins, const glm::ivec3& interior,
                      std::span<const glm::dvec4> viewPlanes, double spacing, double phase = 0.5,
                      std::int64_t maxSlices = 1'000'000);

}  // namespace umbrick
