// Finds where on the screen the occlusion of a slice differs from 1 and is still going to be read.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace umbrick {

/// Pixels [min, max) on both axes; empty when some max <= min.
struct ScreenRegion {
  glm::ivec2 min{0}, max{0};
  bool empty() const { return max.x <= min.x || max.y <= min.y; }
  glm::ivec2 extent() const { return empty() ? glm::ivec2(0) : max - min; }
  void include(const ScreenRegion& other);
  void intersect(const ScreenRegion& other);
  bool operator==(const ScreenRegion&) const = default;
};

/// How a slice reads the slice before it: at axis + (pixel - axis) scale, give or take `radius` pixels.
struct SliceStep {
  double scale = 1;
  double radius = 0;
  double deviation = 0;  // standard deviation of what it reads, along an axis, pixels
};

/// A random walk of many steps carries next to no light farther than so many standard deviations: 3e-5 of a Gaussian,
/// of light that is between 0 and 1.
inline constexpr double kWalkReach = 4;

/// Returns for every slice a rectangle outside of which its occlusion is 1 or never read again, except for what light
/// carries farther than kWalkReach.
/// @param covered  for each slice: the pixels that bricks cover
/// @param steps  for each slice; the first is never used
/// @param axis  where the view axis crosses the image, pixels
std::vector<ScreenRegion> occlusionRegions(std::span<const ScreenRegion> covered, std::span<const SliceStep> steps,
                                           const glm::ivec2& size, const glm::dvec2& axis);

}  // namespace umbrick
