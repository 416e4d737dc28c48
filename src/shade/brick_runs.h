// Runs of bricks, front to back: for techniques that cannot draw all bricks of a picture at once.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "umbrick/slice/proxy_slices.h"

namespace umbrick {

/// Splits bricks by planes between them until each run can be drawn, and draws the runs in the order in which every
/// ray meets them: of two sides of a plane, that of the eye comes first.
class BrickRuns {
 public:
  /// Draws a run, or returns false where it is too much; then it comes in two. A single brick has to be drawn.
  using Draw = std::function<bool(std::span<const std::int32_t> positions)>;
  /// @param origins  first owned voxel of each brick
  BrickRuns(const IndexView& view, std::span<const glm::ivec3> origins) : view_(view), origins_(origins) {}
  void draw(const Draw& draw) const;

 private:
  void split(std::span<std::int32_t> positions, const Draw& draw) const;
  bool seesLowSideFirst(int axis, double plane) const;
  const IndexView& view_;
  std::span<const glm::ivec3> origins_;
};

}  // namespace umbrick
