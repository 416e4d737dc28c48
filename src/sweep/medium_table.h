// The transfer function as the CPU's renderers integrate it: its medium and the integral of that at equal steps.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "sweep/stretch_table.h"
#include "umbrick/core/range.h"
#include "umbrick/optics/transfer_function.h"

namespace umbrick {

/// A 1D function at whole steps t of the value, and the integral over t from step 0 on. Where the value runs linearly
/// from step a to step b, the mean medium is (integral(b) - integral(a)) / (b - a), so that no peak in between is
/// missed. Integrals are whole numbers of 31 bits, since the difference of two floats would keep only 24 bits of the
/// sum. A 2D function has points and integrals over the value for each step of the gradient.
///
/// Extinction is bounded by what is opaque over any segment, which keeps those bits for what is not.
class MediumTable {
 public:
  /// @param exact     a value that is met by a step to the last bit, if it lies within the function: that of empty
  /// space
  /// @param most      largest sigma_t that makes a difference, 1/world unit
  /// @param hiding    sigma_t from which on a part of a segment may hide colours behind others of it: such a function
  ///   gets stretches()
  MediumTable(const TransferFunction& transfer, double exact, double most,
              double hiding = std::numeric_limits<double>::infinity());

  bool is2d() const { return gradientSteps_ > 0; }
  /// The value of a voxel in steps: (value - origin()) * perUnit() + first().
  double origin() const { return origin_; }
  double perUnit() const { return perUnit_; }
  double first() const { return first_; }
  double stepsOf(double value) const { return (value - origin_) * perUnit_ + first_; }
  double gradientPerUnit() const { return gradientPerUnit_; }
  double gradientStepsOf(double gradient) const { return (gradient - gradientOrigin_) * gradientPerUnit_; }

  /// Steps run from 0 to steps(); beyond, the function is constant.
  int steps() const { return steps_; }
  int gradientSteps() const { return gradientSteps_; }
  /// sigma_t, then sigma_s of red, green and blue, 1/world unit, of each step: 4 (steps() + 1) numbers; of a 2D
  /// function for each step of the gradient, value fastest.
  const float* points() const { return points_.data(); }
  /// The integrals of the same four over the value from step 0 on, in units of sumUnit().
  const std::int32_t* sums() const { return sums_.data(); }
  float sumUnit() const { return sumUnit_; }
  /// What sums() leaves of the integrals, in units of sumUnit() / kRests; null where nobody needs it: where extinction
  /// is a thousand times larger elsewhere, 31 bits of the whole leave too few for it.
  const std::int32_t* rests() const { return rests_.empty() ? nullptr : rests_.data(); }
  static constexpr int kRests = 1 << 20;

  /// The function's stretches, over which thick segments are integrated one by one; null: their means will do.
  const StretchTable* stretches() const { return stretches_.empty() ? nullptr : &stretches_; }

  /// Tells whether the medium is empty for all values between two, and for all gradients between two.
  bool isTransparent(const Range& value, const Range& gradient) const;

 private:
  void fill1d(const TransferFunction& transfer, double most);
  void fill2d(const TransferFunction& transfer, double most);
  /// Where counts_ has the number of those with medium before a column, which are the steps of the value and the ways
  /// behind them in turn, and below a step of the gradient.
  std::size_t countAt(int column, int gradient) const {
    return static_cast<std::size_t>(gradient) * static_cast<std::size_t>(2 * steps_ + 3) +
           static_cast<std::size_t>(column);
  }

  double origin_ = 0, perUnit_ = 1, first_ = 0, gradientOrigin_ = 0, gradientPerUnit_ = 1;
  int steps_ = 0, gradientSteps_ = 0;
  float sumUnit_ = 1;
  std::vector<float> points_;
  std::vector<std::int32_t> sums_, rests_;
  StretchTable stretches_;
  /// Of a 1D function: how many of the steps and of the ways behind them, in turn, have medium before each. Of a 2D
  /// function a table of sums, see countAt().
  std::vector<std::int64_t> counts_;
};

}  // namespace umbrick
