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

/// Returns the value in a cell of a brick with voxels. @param cell  of its array, the apron included
/// @param share  from the cell's first voxel, in [0, 1]
inline double valueInCell(const BrickVoxels& voxels, const VoxelBrick& brick, const glm::i64vec3& cell,
                          const glm::dvec3& share) {
  const glm::ivec3 edge = voxels.volume().layout.edge();
  const std::ptrdiff_t strideY = edge.x, strideZ = strideY * edge.y;
  const std::ptrdiff_t first = (cell.z * edge.y + cell.y) * edge.x + cell.x;
  const auto alongX = [&](std::ptrdiff_t at) {
    const double a = voxelValue(voxels, brick, at), b = voxelValue(voxels, brick, at + 1);
    return a + share.x * (b - a);
  };
  const auto alongY = [&](std::ptrdiff_t at) {
    const double a = alongX(at), b = alongX(at + strideY);
    return a + share.y * (b - a);
  };
  const double a = alongY(first), b = alongY(first + strideZ);
  return a + share.z * (b - a);
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
    const std::int64_t apron = voxels_.volume().layout.apron;
    return valueInCell(voxels_, *brick, whole_ - glm::i64vec3(entry_->origin) + apron, share_);
  }

 private:
  const BrickVoxels& voxels_;
  glm::i64vec3 whole_{0};
  glm::dvec3 share_{0};
  const PlacedBrick* entry_ = nullptr;
};

}  // namespace umbrick
