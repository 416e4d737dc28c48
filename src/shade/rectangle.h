// Rectangles on slices tell where something is seen, occludes or is read.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <limits>

namespace umbrick {

/// An axis-parallel rectangle as a set of points; empty when some max <= min.
struct Rectangle {
  glm::dvec2 min{std::numeric_limits<double>::infinity()}, max{-std::numeric_limits<double>::infinity()};
  bool empty() const { return !(max.x > min.x && max.y > min.y); }
  /// Grows to hold the other rectangle, too, unless that is empty.
  void include(const Rectangle& other) {
    if (other.empty()) return;
    min = glm::min(min, other.min);
    max = glm::max(max, other.max);
  }
  /// Grows to hold a point, too; a rectangle of a single point is still empty.
  void include(const glm::dvec2& point) {
    min = glm::min(min, point);
    max = glm::max(max, point);
  }
  Rectangle within(const Rectangle& other) const { return {glm::max(min, other.min), glm::min(max, other.max)}; }
  Rectangle grown(double by) const { return empty() ? *this : Rectangle{min - by, max + by}; }
  Rectangle moved(const glm::dvec2& by) const { return {min + by, max + by}; }
};

}  // namespace umbrick
