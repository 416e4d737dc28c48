// Which voxels of one lattice the voxels of another cover, along one axis.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace umbrick {

/// Source voxel i covers [i, i + 1]; of the `count` new voxels, j covers [edge(j), edge(j + 1)].
class BoxOverlap {
 public:
  /// @param voxels  of the source  @param ratio  new spacing / source spacing
  BoxOverlap(std::int64_t voxels, double ratio) : voxels_(static_cast<double>(voxels)), ratio_(ratio) {
    // A rest of less than a thousandth of a new voxel comes from headers of few digits: no voxel is made for it, and
    // a whole number of voxels fills the source exactly.
    constexpr double kRest = 1e-3;
    const double wanted = voxels_ / ratio;
    fills_ = std::abs(wanted - std::round(wanted)) <= kRest && std::round(wanted) >= 1;
    count_ = fills_ ? std::round(wanted) : std::ceil(wanted);
  }
  /// A double, since it may be too large for any integer.
  double count() const { return count_; }
  double edge(std::int64_t j) const {
    const auto at = static_cast<double>(j);
    return std::min(fills_ ? at * voxels_ / count_ : at * ratio_, voxels_);
  }
  /// First source voxel that new voxel j covers some of.
  std::int64_t first(std::int64_t j) const {
    return std::min(static_cast<std::int64_t>(std::floor(edge(j))), static_cast<std::int64_t>(voxels_) - 1);
  }
  /// One behind the last.
  std::int64_t end(std::int64_t j) const {
    return std::max(static_cast<std::int64_t>(std::ceil(edge(j + 1))), first(j) + 1);
  }
  /// Length, in source voxels, that new voxel j covers of source voxel i, which is one of its own.
  double weight(std::int64_t j, std::int64_t i) const {
    const auto at = static_cast<double>(i);
    return std::min(edge(j + 1), at + 1) - std::max(edge(j), at);
  }

 private:
  double voxels_, ratio_, count_;
  bool fills_;
};

}  // namespace umbrick
