// Where in space each brick lies: a sparse table of the cells of their lattice.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "sweep/brick_voxels.h"

namespace umbrick {

/// Finds bricks by their place. What is not visible is no more than a value.
class BrickTable {
 public:
  explicit BrickTable(const BrickVoxels& voxels);

  /// Returns the cell that owns a voxel along an axis.
  std::int64_t cellOf(std::int64_t voxel, int axis) const {
    const std::int64_t offset = voxel - base_[axis], edge = interior_[axis];
    return offset >= 0 ? offset / edge : -((edge - 1 - offset) / edge);
  }
  std::int64_t firstOf(std::int64_t cell, int axis) const { return base_[axis] + cell * interior_[axis]; }
  /// Returns the brick of a cell; null: there is nothing but background.
  const PlacedBrick* find(const std::array<std::int64_t, 3>& cell) const;

 private:
  static constexpr int kBlock = 16;  // cells of a block along each axis
  using Block = std::array<std::int32_t, kBlock * kBlock * kBlock>;
  static std::size_t placeIn(const std::array<std::int64_t, 3>& cell) {
    return static_cast<std::size_t>(((cell[2] % kBlock) * kBlock + cell[1] % kBlock) * kBlock + cell[0] % kBlock);
  }

  glm::ivec3 interior_, base_{0};
  std::array<std::int64_t, 3> cells_{}, blocks_{};
  std::vector<std::unique_ptr<Block>> table_;
  std::vector<PlacedBrick> entries_;
};

inline const PlacedBrick* BrickTable::find(const std::array<std::int64_t, 3>& cell) const {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (cell[axis] < 0 || cell[axis] >= cells_[axis]) return nullptr;
  const auto block = ((cell[2] / kBlock) * blocks_[1] + cell[1] / kBlock) * blocks_[0] + cell[0] / kBlock;
  const Block* const cells = table_[static_cast<std::size_t>(block)].get();
  if (!cells) return nullptr;
  const std::int32_t number = (*cells)[placeIn(cell)];
  return number < 0 ? nullptr : &entries_[static_cast<std::size_t>(number)];
}

}  // namespace umbrick
