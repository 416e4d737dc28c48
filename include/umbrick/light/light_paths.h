// Directions of the light as sweeps take them through a volume: sorted by axes, and where their paths lie on a slice.
// What computes light volumes has these in common, on the CPU and elsewhere, so that they follow the same paths.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "umbrick/scene/lights.h"

namespace umbrick {

/// The axes of index space as a sweep sees them: u and v lie in its slices, u fastest in memory; n goes from slice to
/// slice.
struct SweepAxes {
  int u = 0, v = 1, n = 2;
};
inline constexpr SweepAxes kSweepAxes[3]{{1, 2, 0}, {0, 2, 1}, {0, 1, 2}};  // by n

/// A direction in index space as a sweep sees it.
struct SweptDirection {
  int axis = 2;                   // along which the direction's largest component is
  int sign = 1;                   // of that component: light comes from there
  double u = 0, v = 0;            // how a path moves across from slice to slice, away from the light, voxels
  double length = 1;              // of the path between two slices, world units
  std::array<float, 3> weight{};  // by channel: share of the whole light
  bool operator==(const SweptDirection&) const = default;
};

/// Directions that may share a sweep: of one axis and one sign.
struct SweepSide {
  int axis = 2, sign = 1;
  std::vector<SweptDirection> directions;
};
/// Sorts directions into sweeps. @param whole  see wholeLight
std::vector<SweepSide> sweepSides(std::span<const LightDirection> directions, const glm::dvec3& whole,
                                  const glm::dmat4& indexToWorld);

/// Returns the sum of the radiances.
glm::dvec3 wholeLight(std::span<const LightDirection> directions);
/// Tells whether the directions' radiances differ in more than brightness, so that there are three channels of light.
bool isColoured(std::span<const LightDirection> directions);

/// Where the paths of a direction lie on a slice: path p is at p + whole + share, in places of light.
struct PathPlace {
  int whole = 0;
  double share = 0;  // in [0, 1)
  /// The voxel at or before a path at the beginning of a cell of places, and how far the path lies behind it.
  int voxel(int spacing) const { return static_cast<int>(share * spacing); }
  float behindVoxel(int spacing) const { return static_cast<float>(share * spacing - voxel(spacing)); }
};

/// That depends on the slice alone, so that it is the same however the volume is cut into bricks.
/// @param across  SweptDirection::u or v
inline PathPlace pathPlace(int sign, double across, int spacing, int n) {
  const double moved = -sign * static_cast<double>(n) * across / spacing;
  const double whole = std::floor(moved);
  return {static_cast<int>(whole), moved - whole};
}

/// How the paths of a direction meet a plane that cuts the medium.
struct PathCut {
  double rate = 0;  // by which a path's distance from the plane grows from slice to slice, in units of the plane
  /// By how many slices later paths meet it that lie a place of light farther out, along the axis nearest to its
  /// normal.
  double slicesPerPlace = 1;
  double cosine = 1;  // between the light and the plane's normal, world
};
/// @param plane    see LightMedium::planes
/// @param toIndex  of directions, from the world
/// @param spacing  voxels between places of light
PathCut pathCut(const glm::dvec4& plane, const SweptDirection& direction, const glm::dmat3& toIndex, int spacing);

}  // namespace umbrick
