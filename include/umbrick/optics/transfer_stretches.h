// The stretches between the control points of a transfer function, which renderers integrate over one by one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <limits>
#include <vector>

namespace umbrick {

/// The part [lower, upper) of an axis of a transfer function, on which the function is linear between the control
/// points `low` and `high`. A step has no stretch of its own: the stretch below it ends at the step's first control
/// point, and the one above begins at its last.
struct AxisStretch {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  std::size_t low = 0, high = 0;  // positions of control points in the axis; equal in the constant ends
};

/// Returns the stretches of an axis in ascending order. There is one more than the axis has different control points;
/// the first and the last are the constant ends. A value v lies in the stretch whose number is the count of different
/// control points at or below v.
/// @param axis  values() or gradients() of a TransferFunction: ascending, at most two equal ones in a row, not empty
std::vector<AxisStretch> axisStretches(const std::vector<double>& axis);

}  // namespace umbrick
