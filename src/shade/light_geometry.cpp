// SPDX-License-Identifier: Apache-2.0
#include "shade/light_geometry.h"

#include <algorithm>
#include <limits>
#include <string>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {

// Unless the scene asks for more, so many texels lie along the diagonal of a volume: a light window then takes some 16
// MiB for each direction at most.
constexpr double kMostTexelsAlong = 2048;

// Returns a rectangle around all that visible bricks cover across, on whatever slice, in texels.
Rectangle bricksAcross(const LitVolume& volume, const LightLattice& lattice) {
  Rectangle across;
  for (const glm::ivec3& origin : volume.bricks) {
    const glm::dvec3 low = glm::dvec3(origin) - 0.5;
    for (unsigned c = 0; c < 8; ++c) {
      const glm::dvec3 corner = low + glm::dvec3(volume.interior) * glm::dvec3(c & 1, c >> 1 & 1, c >> 2 & 1);
      across.include(glm::dvec2(volume.view.toView(corner)) / lattice.texel - lattice.shift);
    }
  }
  return across;
}

// Lays the lattice over `all`, in texels.
void cover(LightLattice& lattice, const Rectangle& all, int mostTexels) {
  if (all.empty()) return;
  const glm::dvec2 low = glm::floor(all.min) - 2.0, high = glm::ceil(all.max) + 2.0;
  const glm::dvec2 texels = high - low;
  // The light windows, which are as large, have the same limit.
  if (!(std::max(texels.x, texels.y) <= mostTexels))
    throw InvalidArgument("occlusion.scale: window texels of " + std::to_string(lattice.texel) +
                          " are too small, light needs more of them side by side than the driver's limit of " +
                          std::to_string(mostTexels));
  lattice.first = glm::ivec2(low);
  lattice.size = glm::ivec2(texels);
}

// Converts planes of the eye's view coordinates to those of a view whose centre lies at `centre`.
std::vector<glm::dvec4> planesFrom(const glm::dvec2& centre, std::span<const glm::dvec4> planes) {
  std::vector<glm::dvec4> moved(planes.begin(), planes.end());
  for (glm::dvec4& plane : moved) plane.w += plane.x * centre.x + plane.y * centre.y;
  return moved;
}

}  // namespace

double latticeTexel(double scale, double spacing, double voxelEdge, double diagonal) {
  if (scale > 0) return voxelEdge / scale;
  // Paths are off by up to a texel across and half a slab along: neither alone is worth refining, and slabs thinner
  // than texels let more light through what is thinner than a texel. Detail below a voxel is not worth it either; that
  // of a pixel does not matter, since occluders smaller than that cast shadows, too.
  return std::max({spacing, voxelEdge, diagonal / kMostTexelsAlong});
}

IndexView latticeView(const IndexView& eye, const LightLattice& lattice) {
  const glm::dvec2 centre = lattice.centre();
  IndexView view = eye;
  view.projection = Projection::orthographic;
  view.halfExtent = 0.5 * lattice.texel * glm::dvec2(lattice.size);
  view.size = lattice.size;
  view.centre = glm::dvec2(0);
  view.origin -= glm::dvec3(centre, 0);
  view.eyeIndex += centre.x * eye.toIndex[0] + centre.y * eye.toIndex[1];
  return view;
}

std::vector<Rectangle> polygonExtents(const LatticePolygons& polygons) {
  std::vector<Rectangle> extents(static_cast<std::size_t>(polygons.slices.count()));
  for (std::int64_t i = 0; i < polygons.slices.count(); ++i)
    forEachPolygon(polygons, i,
                   [&](const Rectangle& polygon) { extents[static_cast<std::size_t>(i)].include(polygon); });
  return extents;
}

std::vector<Rectangle> neededRegions(const LightExtents& extents, const LightPaths& paths) {
  const std::size_t count = extents.depths.size();
  std::vector<Rectangle> needed(count);
  const auto addPathsOf = [&](const LightSlope& light) {
    Rectangle read;  // paths that are read on slice i or a later one, where they cross the plane of the eye
    for (std::size_t i = count; i-- > 0;) {
      const glm::dvec2 shift = extents.depths[i] / extents.texel * light.slope;
      if (!extents.seen[i].empty()) read.include(extents.seen[i].moved(shift));
      if (!read.empty()) needed[i].include(read.moved(-shift));
    }
  };
  addPathsOf(paths.view);
  for (const LightSlope& light : paths.lights) addPathsOf(light);
  return needed;
}

LightGeometry lightGeometry(const LitVolume& volume, const LightPaths& paths, double texel, const glm::dvec2& shift,
                            int mostTexels) {
  LightGeometry light;
  light.lattice.texel = texel;
  light.lattice.shift = shift;
  // The first step finds what the eye sees, and from where that can be occluded: this is where the lattice has to be.
  light.extents.texel = texel;
  for (std::int64_t i = 0; i < volume.slices.count(); ++i) light.extents.depths.push_back(volume.slices.depth(i));
  light.extents.seen = polygonExtents(light.seen(volume));
  const std::vector<Rectangle> needed = neededRegions(light.extents, paths);
  const Rectangle bricks = bricksAcross(volume, light.lattice);
  Rectangle all;
  for (const Rectangle& region : needed) all.include(region.within(bricks));
  cover(light.lattice, all, mostTexels);
  // The second step cuts the same slices once more, as they lie on the lattice: this is what occludes.
  const glm::dvec2 centre = light.lattice.centre();
  light.view = latticeView(volume.view, light.lattice);
  light.planes = planesFrom(centre, volume.planes);
  light.slices = cutSlices(light.view, volume.bricks, volume.interior, planesFrom(centre, volume.bounds),
                           volume.slices.spacing, volume.slices.phase);
  light.extents.occluding = polygonExtents(light.occluding());
  for (std::size_t i = 0; i < needed.size(); ++i)
    light.extents.occluding[i] = light.extents.occluding[i].within(needed[i].grown(2));
  return light;
}

}  // namespace umbrick
