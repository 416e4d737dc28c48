// A 1D transfer function as the stretches between its control points, where the CPU's renderers integrate it exactly.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "umbrick/optics/transfer_function.h"

namespace umbrick {

/// The stretches of a function in steps of a MediumTable, with the media at their ends.
class StretchTable {
 public:
  /// What is known of a stretch: its ends in steps, sigma_t at both, then red, green and blue of the albedo at the
  /// lower end and at the upper one; padded.
  static constexpr int kNumbers = 12;

  StretchTable() = default;
  /// @param stepsOf  turns a value into steps
  /// @param steps    of the table
  /// @param most     largest sigma_t that makes a difference, 1/world unit
  StretchTable(const TransferFunction& transfer, const std::function<double(double)>& stepsOf, int steps, double most);

  bool empty() const { return numbers_.empty(); }
  const float* numbers() const { return numbers_.data(); }
  int count() const { return static_cast<int>(numbers_.size()) / kNumbers; }
  /// Of each step: the stretch that it lies in.
  const std::int32_t* stretchAt() const { return stretchAt_.data(); }

 private:
  std::vector<float> numbers_;
  std::vector<std::int32_t> stretchAt_;
};

}  // namespace umbrick
