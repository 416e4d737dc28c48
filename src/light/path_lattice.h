// The optical depths of the paths of one direction, on a plane lattice that moves with them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "umbrick/light/light_paths.h"

namespace umbrick {

/// Depths are 0 at first. A lattice is held in a plane that is larger by kSlack texels along each axis, and moved there
/// when paths have moved so far.
class PathLattice {
 public:
  static constexpr int kSlack = 64;
  /// @param width,height  places of light in a plane of the sweep
  PathLattice(const SweptDirection& direction, int width, int height, int padding)
      : width_(width + kSlack),
        height_(height + kSlack),
        padding_(static_cast<std::size_t>(padding)),
        depth_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) + padding_, 0.0f),
        offset_{direction.u > 0 ? kSlack : 0, direction.v > 0 ? kSlack : 0} {}

  /// Moves on to a slice where paths have moved so far.
  void moveTo(int wholeU, int wholeV) {
    const int shiftU = rebased(offset_[0], wholeU), shiftV = rebased(offset_[1], wholeV);
    if (shiftU != 0 || shiftV != 0) shift(shiftU, shiftV);
    whole_ = {wholeU, wholeV};
  }
  /// Returns the path of the row that lies at or just behind this column of the plane of places.
  float* row(int row, int column) {
    const std::ptrdiff_t v = row - whole_[1] + offset_[1], u = column - whole_[0] + offset_[0];
    return depth_.data() + v * width_ + u;
  }

 private:
  // Returns by how much to move what the plane holds, so that the place of the first column stays in [0, kSlack].
  static int rebased(int& offset, int whole) {
    const int place = offset - whole;
    const int steps = place < 0 ? (kSlack - 1 - place) / kSlack : place > kSlack ? -((place - 1) / kSlack) : 0;
    const int moved = steps * kSlack;
    offset += moved;
    return moved;
  }
  void shift(int u, int v) {
    std::vector<float> moved(depth_.size(), 0.0f);
    const int first = std::max(0, u), last = std::min(width_, width_ + u);
    for (int row = std::max(0, v); row < std::min(height_, height_ + v); ++row)
      std::copy_n(depth_.data() + std::ptrdiff_t(row - v) * width_ + first - u, std::max(last - first, 0),
                  moved.data() + std::ptrdiff_t(row) * width_ + first);
    depth_.swap(moved);
  }

  int width_, height_;
  std::size_t padding_;
  std::vector<float> depth_;
  std::array<int, 2> offset_, whole_{};
};

}  // namespace umbrick
