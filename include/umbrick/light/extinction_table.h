// The transfer function as paths of light integrate it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "umbrick/core/range.h"
#include "umbrick/optics/transfer_function.h"

namespace umbrick {

/// The integral S of sigma_t over the value, at equal steps of the value. Between two slices the value along a path
/// runs linearly, so the mean of sigma_t there is (S(b) - S(a)) / (b - a): no peak of the function is missed, and
/// surfaces lie where the value says, not where voxels do. Values count in steps of the table, from its first entry on.
class ExtinctionTable {
 public:
  static constexpr int kSteps = 4096;
  static constexpr int kEnds = 4;  // steps before the first control point and behind the last, of a 1D function
  explicit ExtinctionTable(const TransferFunction& transfer);

  /// Returns the value of a voxel in steps of the table. For a 2D function this is sigma_t, and means are of its ends.
  float stepsOf(float value, float gradient) const {
    if (transfer_.is2d()) return static_cast<float>(transfer_(value, gradient).sigma_t * perUnit_);
    // The first control point is an entry to the last bit: values there, where functions often begin, have no
    // extinction.
    return static_cast<float>(kEnds + (static_cast<double>(value) - low_) * perUnit_);
  }
  /// Does the same for voxels in place. @param gradients  of a 2D function
  void toSteps(std::span<float> values, std::span<const float> gradients) const;
  /// Tells whether sigma_t is 0 for all values between two, in steps. Between ends of the function, values less than a
  /// step from some with extinction count as having it.
  bool isTransparent(float low, float high) const {
    if ((low < 0 && below() > 0) || (high > kSteps && above() > 0)) return false;
    const auto at = [](float steps) {
      return static_cast<std::size_t>(std::min(std::max(steps, 0.0f), float(kSteps)));
    };
    if (high <= emptyBelow_ || low >= emptyAbove_) return true;
    return opaque_[std::min<std::size_t>(at(high) + 1, kSteps)] == opaque_[at(low)];
  }

  /// Tells whether sigma_t is above 0 all the way between two values. May be false where it is.
  bool isOpaque(float low, float high) const {
    if (low < 0 || high > kSteps || low <= emptyBelow_ || high >= emptyAbove_) return false;
    const auto first = static_cast<std::size_t>(low), last = static_cast<std::size_t>(high);
    return last < kSteps && opaque_[last + 1] - opaque_[first] == static_cast<std::int32_t>(last + 1 - first);
  }

  /// A value of a 1D function is kEnds + (value - low()) * perUnit() steps.
  double low() const { return low_; }
  double perUnit() const { return perUnit_; }
  /// Returns the numbers of steps before each entry over which sigma_t is not 0 everywhere, kSteps + 1.
  std::span<const std::int32_t> opaqueSteps() const { return opaque_; }
  const float* integrals() const { return integrals_.data(); }  // kSteps + 2
  const float* means() const { return means_.data(); }          // of sigma_t from each step to the next, kSteps + 1
  float below() const { return below_; }                        // sigma_t of values below the table, 1/world unit
  float above() const { return above_; }
  /// No value up to this one has any extinction; so far below the table that no value is where some have.
  float emptyBelow() const { return emptyBelow_; }
  /// No value from this one on has any.
  float emptyAbove() const { return emptyAbove_; }

 private:
  const TransferFunction& transfer_;
  double low_ = 0, perUnit_ = 1;
  void findEmptyEnds();
  float below_ = 0, above_ = 0, emptyBelow_ = 0, emptyAbove_ = 0;
  std::vector<float> integrals_, means_;
  std::vector<std::int32_t> opaque_;  // number of steps before an entry over which sigma_t is not 0 everywhere
};

}  // namespace umbrick
