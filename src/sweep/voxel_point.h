// The volume at a point, between eight voxels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>

#include "sweep/brick_table.h"
#include "umbrick/core/range.h"

namespace umbrick {

/// Returns the value of a voxel of a brick with voxels. @param index  into its array
inline double voxelValue(const BrickVoxels& voxels, const VoxelBrick& brick, std::ptrdiff_t index) {
  switch (voxels.code()) {
    case VoxelCode::u8:
      return voxels.offset() + BrickVoxels::codes<std::uint8_t>(brick)[index];
    case VoxelCode::u16:
      return voxels.offset() + BrickVoxels::codes<std::uint16_t>(brick)[index];
    case VoxelCode::f16:
      return halfValue(BrickVoxels::codes<HalfCode>(brick)[index]);
    case VoxelCode::f32:
      break;
  }
  return voxels.offset() + static_cast<double>(BrickVoxels::codes<float>(brick)[index]);
}

/// Finds the brick in whose cells a point lies, and interpolates there.
class VoxelPoint {
 public:
  /// @param point  index coordinates
  VoxelPoint(const BrickVoxels& voxels, const BrickTable& table, const glm::dvec3& point) : voxels_(voxels) {
    std::array<std::int64_t, 3> cell;
    for (int axis = 0; axis < 3; ++axis) {
      const double below = std::floor(point[axis]);
      whole_[axis] = static_cast<std::int64_t>(below);
      share_[axis] = point[axis] - below;
      cell[static_cast<std::size_t>(axis)] = table.cellOf(whole_[axis], axis);
    }
    entry_ = table.find(cell);
  }

  /// Returns the values among which that of the point is.
  Range range() const {
    if (entry_ && entry_->brick) return entry_->brick->value;
    const float single = entry_ ? entry_->value : voxels_.volume().background;
    return {single, single};
  }

  double value() const {
    const VoxelBrick* const brick = entry_ ? entry_->brick : nullptr;
    if (!brick || !brick->voxels) return range().min;
    const BrickLayout& layout = voxels_.volume().layout;
    const glm::ivec3 edge = layout.edge();
    const std::ptrdiff_t strideY = edge.x, strideZ = strideY * edge.y;
    std::ptrdiff_t place[3];
    for (int axis = 0; axis < 3; ++axis) place[axis] = whole_[axis] - entry_->origin[axis] + layout.apron;
    const std::ptrdiff_t first = (place[2] * edge.y + place[1]) * edge.x + place[0];
    const auto alongX = [&](std::ptrdiff_t at) {
      const double a = voxelValue(voxels_, *brick, at), b = voxelValue(voxels_, *brick, at + 1);
      return a + share_.x * (b - a);
    };
    const auto alongY = [&](std::ptrdiff_t at) {
      const double a = alongX(at), b = alongX(at + strideY);
      return a + share_.y * (b - a);
    };
    const double a = alongY(first), b = alongY(first + strideZ);
    return a + share_.z * (b - a);
  }

 private:
  const BrickVoxels& voxels_;
  glm::i64vec3 whole_{0};
  glm::dvec3 share_{0};
  const PlacedBrick* entry_ = nullptr;
};

}  // namespace umbrick
