// SPDX-License-Identifier: Apache-2.0
#include "sweep/brick_table.h"

#include "umbrick/core/memory.h"

namespace umbrick {

BrickTable::BrickTable(const BrickVoxels& voxels)
    : interior_(voxels.volume().layout.interior), entries_(voxels.allBricks()) {
  if (entries_.empty()) return;
  glm::ivec3 last = entries_.front().origin;
  base_ = last;
  for (const PlacedBrick& entry : entries_) {
    base_ = glm::min(base_, entry.origin);
    last = glm::max(last, entry.origin);
  }
  std::size_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    cells_[at] = cellOf(last[axis], axis) + 1;
    blocks_[at] = (cells_[at] + kBlock - 1) / kBlock;
    count *= static_cast<std::size_t>(blocks_[at]);
  }
  requireMemory("rays: a table of where bricks lie", static_cast<double>(count) * sizeof(table_.front()));
  table_.resize(count);
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    std::array<std::int64_t, 3> cell;
    for (int axis = 0; axis < 3; ++axis) cell[static_cast<std::size_t>(axis)] = cellOf(entries_[i].origin[axis], axis);
    auto& block = table_[static_cast<std::size_t>(((cell[2] / kBlock) * blocks_[1] + cell[1] / kBlock) * blocks_[0] +
                                                  cell[0] / kBlock)];
    if (!block) {
      block = std::make_unique<Block>();
      block->fill(-1);
    }
    (*block)[placeIn(cell)] = static_cast<std::int32_t>(i);
  }
}

}  // namespace umbrick
