// SPDX-License-Identifier: Apache-2.0
#include "shade/light_slabs.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/common.hpp>

#include "shade/constants.h"

namespace umbrick {
namespace {

int roundedUp(int number, int multiple) { return (number + multiple - 1) / multiple * multiple; }

int floorDivide(int number, int divisor) {
  return number >= 0 ? number / divisor : -((divisor - 1 - number) / divisor);
}

}  // namespace

glm::ivec3 LitBricks::blocks() const { return (layout.interior + kLitBlock - 1) / kLitBlock; }
std::size_t LitBricks::blocksPerBrick() const {
  const glm::ivec3 count = blocks();
  return static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y) * static_cast<std::size_t>(count.z);
}

LightSlabs::LightSlabs(int axis, const LitBricks& bricks) : axis_(axis) {
  const SweepAxes axes = kSweepAxes[axis];
  const int apron = bricks.layout.apron;
  // Paths around the outermost voxels with light, of which squares of kLitBlock voxels begin where blocks do.
  margin_ = roundedUp(apron + 2, kLitBlock);
  size_ = glm::ivec2(bricks.extent[axes.u], bricks.extent[axes.v]) + 2 * margin_;
  marksSize_ = (size_ + kLitBlock - 1) / kLitBlock;
  first_ = -roundedUp(apron, kSlabSlices);
  count_ = (roundedUp(bricks.extent[axes.n] + apron, kSlabSlices) - first_) / kSlabSlices;
  marks_.assign(static_cast<std::size_t>(count_) * static_cast<std::size_t>(marksSize_.x) *
                    static_cast<std::size_t>(marksSize_.y),
                0);
  // Once to count the blocks of each slab, and once to list them.
  start_.assign(static_cast<std::size_t>(count_) + 1, 0);
  const std::size_t each = bricks.blocksPerBrick();
  std::vector<std::uint32_t> next;
  for (const bool lists : {false, true}) {
    for (std::size_t i = 0; i < bricks.lit.size(); ++i) {
      if (bricks.lit[i] == 0) continue;
      const auto block = static_cast<int>(i % each);
      const glm::ivec3 count = bricks.blocks(),
                       at(block % count.x, block / count.x % count.y, block / (count.x * count.y));
      const glm::ivec3 place = bricks.places[i / each];
      glm::ivec3 low = kLitBlock * at, high = low + kLitBlock;
      for (int a = 0; a < 3; ++a) {
        if (at[a] == 0) low[a] = -apron;
        if (at[a] + 1 == count[a]) high[a] = bricks.layout.interior[a] + apron;
      }
      low += place;
      high += place;
      const int last = floorDivide(high[axes.n] - 1 - first_, kSlabSlices);
      for (int slab = floorDivide(low[axes.n] - first_, kSlabSlices); slab <= last; ++slab) {
        if (!lists) {
          ++start_[static_cast<std::size_t>(slab) + 1];
          std::uint8_t* const marks = marks_.data() + static_cast<std::size_t>(slab) *
                                                          static_cast<std::size_t>(marksSize_.x) *
                                                          static_cast<std::size_t>(marksSize_.y);
          for (int v = (low[axes.v] + margin_) / kLitBlock; v <= (high[axes.v] - 1 + margin_) / kLitBlock; ++v)
            for (int u = (low[axes.u] + margin_) / kLitBlock; u <= (high[axes.u] - 1 + margin_) / kLitBlock; ++u)
              marks[static_cast<std::ptrdiff_t>(v) * marksSize_.x + u] = 1;
        } else {
          blocks_[next[static_cast<std::size_t>(slab)]++] = glm::uvec2(i / each, block);
        }
      }
    }
    if (lists) break;
    for (std::size_t slab = 0; slab < static_cast<std::size_t>(count_); ++slab) start_[slab + 1] += start_[slab];
    blocks_.resize(start_.back());
    next.assign(start_.begin(), start_.end() - 1);
  }
}

int LightSlabs::slices() const { return count_ * kSlabSlices; }

int LightSlabs::slice(int sign, int step) const { return sign > 0 ? first_ + slices() - 1 - step : first_ + step; }

SidePaths::SidePaths(const LightSlabs& slabs, const glm::i64vec3& first, std::span<const SweptDirection> directions)
    : directions_(directions.size()) {
  const SweepAxes axes = kSweepAxes[slabs.axis()];
  const int slices = slabs.slices();
  places_.resize(static_cast<std::size_t>(slices + 1) * directions_);
  for (std::size_t k = 0; k < directions_; ++k) {
    const SweptDirection& direction = directions[k];
    std::vector<std::array<PathPlace, 2>> on;
    glm::ivec2 low(0), high(0);
    for (int step = -1; step < slices; ++step) {
      const auto n = static_cast<int>(first[axes.n] + slabs.slice(direction.sign, step));
      on.push_back({pathPlace(direction.sign, direction.u, 1, n), pathPlace(direction.sign, direction.v, 1, n)});
      const glm::ivec2 whole(on.back()[0].whole, on.back()[1].whole);
      low = step < 0 ? whole : glm::min(low, whole);
      high = step < 0 ? whole : glm::max(high, whole);
    }
    for (std::size_t i = 0; i < on.size(); ++i)
      places_[i * directions_ + k] = {static_cast<float>(on[i][0].whole - high.x),
                                      static_cast<float>(on[i][1].whole - high.y), static_cast<float>(on[i][0].share),
                                      static_cast<float>(on[i][1].share)};
    size_ = glm::max(size_, slabs.planeSize() + high - low);
  }
}

// The tiles of one slab. A tile's paths are told by where they are on the slab's first slice.
std::vector<std::uint32_t> SidePaths::tilesOf(const LightSlabs& slabs, int sign, int place) const {
  const glm::ivec2 marksSize = slabs.marksSize_, size = slabs.planeSize() / kPathTile + 2 * kFirstPathTile + 1;
  const std::uint8_t* const marks = slabs.marks_.data() + static_cast<std::size_t>(slabs.slab(sign, place)) *
                                                              static_cast<std::size_t>(marksSize.x) *
                                                              static_cast<std::size_t>(marksSize.y);
  std::vector<std::uint32_t> list;
  if (slabs.blockCount(slabs.slab(sign, place)) == 0) return list;
  std::vector<std::uint8_t> listed(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
  const auto at = [&](int slice, std::size_t k) {
    const glm::vec4& path = places_[static_cast<std::size_t>(place * kSlabSlices + slice + 1) * directions_ + k];
    return glm::ivec2(static_cast<int>(path.x), static_cast<int>(path.y));
  };
  for (std::size_t k = 0; k < directions_; ++k) {
    std::ranges::fill(listed, std::uint8_t{0});
    const glm::ivec2 moved = at(kSlabSlices - 1, k) - at(0, k);
    // The paths around a square's voxels are from the voxel before the first one on.
    const glm::ivec2 before = glm::max(moved, 0) + 1, behind = kLitBlock - 1 - glm::min(moved, 0);
    for (int v = 0; v < marksSize.y; ++v)
      for (int u = 0; u < marksSize.x; ++u) {
        if (!marks[static_cast<std::ptrdiff_t>(v) * marksSize.x + u]) continue;
        const glm::ivec2 square = kLitBlock * glm::ivec2(u, v), low = square - before, high = square + behind;
        for (int y = floorDivide(low.y, kPathTile); y <= floorDivide(high.y, kPathTile); ++y)
          for (int x = floorDivide(low.x, kPathTile); x <= floorDivide(high.x, kPathTile); ++x) {
            const glm::ivec2 tile = glm::ivec2(x, y) + kFirstPathTile;
            std::uint8_t& one = listed[static_cast<std::size_t>(tile.y) * static_cast<std::size_t>(size.x) +
                                       static_cast<std::size_t>(tile.x)];
            if (one) continue;
            one = 1;
            list.push_back(static_cast<std::uint32_t>(tile.x) | static_cast<std::uint32_t>(tile.y) << kPathTileBits |
                           static_cast<std::uint32_t>(k) << (2 * kPathTileBits));
          }
      }
  }
  return list;
}

void SidePaths::findTiles(const LightSlabs& slabs, int sign) {
  std::vector<std::vector<std::uint32_t>> lists(static_cast<std::size_t>(slabs.count()));
  tbb::parallel_for(tbb::blocked_range<int>(0, slabs.count(), 1), [&](const auto& range) {
    for (int place = range.begin(); place != range.end(); ++place)
      lists[static_cast<std::size_t>(place)] = tilesOf(slabs, sign, place);
  });
  tiles_.clear();
  start_.assign(1, 0);
  for (const std::vector<std::uint32_t>& list : lists) {
    tiles_.insert(tiles_.end(), list.begin(), list.end());
    start_.push_back(static_cast<std::uint32_t>(tiles_.size()));
  }
}

}  // namespace umbrick
