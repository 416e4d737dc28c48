// The geometry of the light of one picture: the lattice on which light is known, and where on it something is seen or
// occludes. shaders/README.md draws the frames of reference.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "shade/light_aim.h"
#include "shade/rectangle.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

/// The grid of points at which light is known on every slice: texel (i, j) covers
/// [first + shift + (i, j), first + shift + (i + 1, j + 1)] * texel in view coordinates. It is the same for all slices
/// and aligned with the view axis, so that it does not depend on which bricks there are.
struct LightLattice {
  double texel = 1;     // edge of a texel, world units
  glm::dvec2 shift{0};  // texels
  glm::ivec2 first{0}, size{1};
  glm::dvec2 offset() const { return shift * texel; }
  glm::dvec2 centre() const { return (glm::dvec2(first) + shift + 0.5 * glm::dvec2(size)) * texel; }
};

/// Returns the edge of the lattice's texels, world units.
/// @param scale  texels per voxel edge; 0: the renderer chooses
/// @param voxelEdge,diagonal  shortest edge of a voxel, and the diagonal of the volume, world units
double latticeTexel(double scale, double spacing, double voxelEdge, double diagonal);

/// Returns the view of a lattice: parallel, along the view axis of `eye`, with one pixel per texel. Its view
/// coordinates are those of `eye` less the centre of the lattice.
IndexView latticeView(const IndexView& eye, const LightLattice& lattice);

/// Slices with the view that they were cut for, and how their points are converted to texels of a lattice.
struct LatticePolygons {
  const ProxySlices& slices;
  const IndexView& view;
  glm::dvec2 centre;  // centre of the view, world units across from where the lattice's texel (0, 0) begins
  double texel;       // world units
};

/// Calls visit(rectangle) with the extent of each polygon of slice i, in texels.
template <class Visit>
void forEachPolygon(const LatticePolygons& polygons, std::int64_t i, const Visit& visit) {
  const auto& [slices, view, centre, texel] = polygons;
  const double scale = view.projection == Projection::perspective ? slices.depth(i) : 1.0;
  const auto at = static_cast<std::size_t>(i);
  for (auto p = static_cast<std::size_t>(slices.start[at]); p < static_cast<std::size_t>(slices.start[at + 1]); ++p) {
    const ProxyPolygon& polygon = slices.polygons[p];
    Rectangle extent;
    for (std::int32_t v = 0; v < polygon.vertices; ++v) {
      const glm::dvec2 device(slices.vertices[static_cast<std::size_t>(polygon.firstVertex + v)]);
      extent.include(((glm::clamp(device, -1.0, 1.0) * view.halfExtent + view.centre) * scale + centre) / texel);
    }
    visit(extent);
  }
}

/// Returns, for each slice, the rectangle around its polygons, in texels.
std::vector<Rectangle> polygonExtents(const LatticePolygons& polygons);

/// What the slices hold, as rectangles in texels of the lattice.
struct LightExtents {
  double texel = 1;                  // edge of a texel, world units
  std::vector<double> depths;        // of all slices, ascending, world units
  std::vector<Rectangle> seen;       // for each slice: where bricks are visible to the eye
  std::vector<Rectangle> occluding;  // for each slice: where bricks may occlude
  bool holdsNothing(std::size_t slice) const { return seen[slice].empty() && occluding[slice].empty(); }
};

/// Returns, for each slice, the rectangle from which light, or the eye's view, can still be blocked on its way to
/// something seen on that slice or a later one. @pre depths and seen are set
std::vector<Rectangle> neededRegions(const LightExtents& extents, const LightPaths& paths);

/// What the eye sees of a volume, before its light is known.
struct LitVolume {
  const IndexView& view;
  const ProxySlices& slices;
  std::span<const glm::ivec3> bricks;  // first owned voxel of each
  glm::ivec3 interior;                 // owned voxels of a brick
  std::span<const glm::dvec4> planes;  // planes that cut slabs, in view coordinates
  std::span<const glm::dvec4> bounds;  // planes beyond which there is nothing to draw
};

/// What light sees of the same volume.
struct LightGeometry {
  LightLattice lattice;
  LightExtents extents;
  IndexView view;                  // see latticeView
  ProxySlices slices;              // the eye's slices, as many and as deep, cut for that view
  std::vector<glm::dvec4> planes;  // the planes of the volume, in coordinates of that view

  LatticePolygons seen(const LitVolume& volume) const {
    return {volume.slices, volume.view, -lattice.offset(), lattice.texel};
  }
  LatticePolygons occluding() const { return {slices, view, lattice.centre() - lattice.offset(), lattice.texel}; }
};

/// Lays the lattice over the volume and cuts its slices as light sees them.
/// @param texel,shift  of the lattice, see LightLattice
/// @param mostTexels  the largest edge of a texture that the driver takes
/// @throw InvalidArgument  the lattice would need a larger one
LightGeometry lightGeometry(const LitVolume& volume, const LightPaths& paths, double texel, const glm::dvec2& shift,
                            int mostTexels);

}  // namespace umbrick
