// Axis-aligned boxes: of voxels (inclusive integers) and of space.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace umbrick {

/// The voxels from `min` to `max`, both included; empty when max < min along some axis.
struct IndexBox {
  glm::ivec3 min{0};
  glm::ivec3 max{-1};

  bool empty() const { return max.x < min.x || max.y < min.y || max.z < min.z; }
  /// Returns the voxels along each axis, as 64-bit numbers so that boxes near the int32 limits do not overflow.
  glm::i64vec3 extent() const {
    return empty() ? glm::i64vec3(0) : glm::i64vec3(max) - glm::i64vec3(min) + std::int64_t(1);
  }
  bool operator==(const IndexBox&) const = default;
};

/// A box in world space or in continuous index space; empty until a point is included.
struct Box {
  glm::dvec3 min{std::numeric_limits<double>::infinity()};
  glm::dvec3 max{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
  glm::dvec3 centre() const { return 0.5 * (min + max); }
  glm::dvec3 extent() const { return empty() ? glm::dvec3(0) : max - min; }
  void include(const glm::dvec3& point) {
    min = glm::min(min, point);
    max = glm::max(max, point);
  }
  bool operator==(const Box&) const = default;
};

}  // namespace umbrick
