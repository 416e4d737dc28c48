// Which share of a pixel lies on one side of a line: the closed form of what a box filter makes of an edge.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <glm/vec2.hpp>
#include <utility>
#include <vector>

namespace umbrick {

/// A half-plane of the image: the points p with normal . p + offset >= 0, in pixels.
struct HalfPlane {
  glm::dvec2 normal{1, 0};
  double offset = 0;
  double at(const glm::dvec2& p) const { return normal.x * p.x + normal.y * p.y + offset; }
};

/// Returns the area of the half-plane inside the pixel [x, x + 1] x [y, y + 1]: the pixel's square is clipped, and the
/// area of the rest is a sum over its edges.
inline double coverage(const HalfPlane& half, int x, int y) {
  const std::vector<glm::dvec2> square{{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}};
  std::vector<glm::dvec2> kept;
  for (std::size_t i = 0; i < square.size(); ++i) {
    const glm::dvec2 a = square[i], b = square[(i + 1) % square.size()];
    const double da = half.at(a), db = half.at(b);
    if (da >= 0) kept.push_back(a);
    if ((da >= 0) != (db >= 0)) kept.push_back(a + (b - a) * (da / (da - db)));
  }
  double twice = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const glm::dvec2 a = kept[i], b = kept[(i + 1) % kept.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * std::abs(twice);
}

}  // namespace umbrick
