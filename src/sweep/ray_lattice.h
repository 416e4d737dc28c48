// The rays of a shear-warped picture: a lattice of them that meets the voxels' slices in rows.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "umbrick/core/box.h"
#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

/// A view as seen along a main axis n of index space. Rays of the view cross the slices n = const from the front to the
/// back. In a parallel view ray (i, j) is where u and v, on the plane n = reference, are origin + step (i, j); in a
/// perspective one origin + step (i, j) are its slopes du/dn and dv/dn, and all go through the eye. So on every slice
/// rays lie on a lattice along u and v, whose rows are rows of voxels:
///
///     u = start(n).x + i spacing(n).x      v = start(n).y + j spacing(n).y
///
/// Lacroute and Levoy 1994, "Fast Volume Rendering Using a Shear-Warp Factorization of the Viewing Transformation",
/// doi:10.1145/192161.192283, who resample the slices' pixels instead of placing rays.
struct RayLattice {
  int u = 0, v = 1, n = 2;  // axes; u is the fastest in memory that is not n
  int sign = 1;             // of n from front to back
  bool perspective = true;
  glm::dvec3 eye{0};     // along (u, v, n); index coordinates
  glm::dvec2 slope{0};   // of parallel rays, du/dn and dv/dn
  double reference = 0;  // of n, parallel views
  glm::dvec2 origin{0};  // of ray (0, 0)
  glm::dvec2 step{1};    // between rays; has the sign that makes spacing() positive
  int width = 0, height = 0;
  glm::dmat3 metric{1};  // world length of (u, v, n) squared: a quadratic form
  glm::dvec4 depth{0};   // of (u, v, n, 1), along the view axis, world units
  // Screen point p is seen along screen[0] p.x + screen[1] p.y + screen[2], by (u, v, n); parallel views move by the
  // first two.
  std::array<glm::dvec3, 3> screen;

  glm::dvec2 spacing(double at) const { return perspective ? step * (at - eye.z) : step; }
  glm::dvec2 start(double at) const {
    return perspective ? glm::dvec2(eye) + origin * (at - eye.z) : origin + slope * (at - reference);
  }
  /// Slopes of ray (i, j).
  glm::dvec2 slopeOf(double i, double j) const { return perspective ? origin + step * glm::dvec2(i, j) : slope; }
  /// The ray of a screen point as a place in the lattice, from homogeneous coordinates: place = xy / z where z > 0.
  /// They are linear in the screen point.
  glm::dvec3 placeOf(const glm::dvec2& screenPoint) const;
};

/// How rays are placed.
struct LatticeOptions {
  double raysPerVoxel = 1;  // along its shortest edge, in the middle of the volume
  double raysPerPixel = 0;  // at least, there; so that what is enlarged stays sharp
  int most = 8192;          // rays along an axis
};

/// Returns the lattices that a view needs: one whose main axis is nearest to the view axis, or, where rays of a wide
/// view would lie too flat in its slices, one for each axis that is the main one for some rays. Empty: nothing is in
/// front of the eye.
/// @param volume    of all voxels, index coordinates: rays lie where this and the view say
/// @param low,high  of the voxels that show something: there are no rays that miss them
std::vector<RayLattice> rayLattices(const IndexView& view, const glm::dmat3& indexToWorld, const Box& volume,
                                    const glm::dvec3& low, const glm::dvec3& high, const LatticeOptions& options);

/// Tells whether the ray of a screen point runs along the lattice's main axis more than along the others.
bool isMain(const RayLattice& lattice, const glm::dvec2& screenPoint);

}  // namespace umbrick
