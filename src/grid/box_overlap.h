// Which voxels of one lattice the voxels of another cover, along one axis.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace umbrick {

/// Voxel i of the source covers [i, i + 1]. Of the `count` new voxels, voxel j covers [edge(j), edge(j + 1)].
class BoxOverlap {
 public:
  /// @param voxels  number of voxels of the source
  /// @param ratio   new spacing / source spacing
  BoxOverlap(std::int64_t voxels, double ratio) : voxels_(static_cast<double>(voxels)), ratio_(ratio) {
    // Headers of few digits leave a rest of less than a thousandth of a new voxel. No voxel is made for such a rest,
    // and a whole number of voxels fills the source exactly.
    constexpr double kRest = 1e-3;
    const double wanted = voxels_ / ratio;
    fills_ = std::abs(wanted - std::round(wanted)) <= kRest && std::round(wanted) >= 1;
    count_ = fills_ ? std::round(wanted) : std::ceil(wanted);
  }
  /// Returns the number of new voxels, as a double since it may be too large for any integer.
  double count() const { return count_; }
  double edge(std::int64_t j) const {
    const auto at = static_cast<double>(j);
    return std::min(fills_ ? at * voxels_ / count_ : at * ratio_, voxels_);
  }
  /// Returns the first source voxel of which new voxel j covers some.
  std::int64_t first(std::int64_t j) const {
    return std::min(static_cast<std::int64_t>(std::floor(edge(j))), static_cast<std::int64_t>(voxels_) - 1);
  }
  /// Returns one more than the last source voxel of which new voxel j covers some.
  std::int64_t end(std::int64_t j) const {
    return std::max(static_cast<std::int64_t>(std::ceil(edge(j + 1))), first(j) + 1);
  }
  /// Returns the length that new voxel j covers of source voxel i, in source voxels; i is in [first(j), end(j)).
  double weight(std::int64_t j, std::int64_t i) const {
    const auto at = static_cast<double>(i);
    return std::min(edge(j + 1), at + 1) - std::max(edge(j), at);
  }

 private:
  double voxels_, ratio_, count_;
  bool fills_;
};

}  // namespace umbrick
