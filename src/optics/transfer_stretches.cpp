// SPDX-License-Identifier: Apache-2.0
#include "umbrick/optics/transfer_stretches.h"

namespace umbrick {

std::vector<AxisStretch> axisStretches(const std::vector<double>& axis) {
  std::vector<AxisStretch> stretches(1);
  for (std::size_t i = 0; i < axis.size(); ++i) {
    const bool secondSide = i > 0 && axis[i] == axis[i - 1];
    if (!secondSide) {
      // The stretch so far ends here, and another one begins.
      stretches.back().upper = axis[i];
      stretches.back().high = i;
      stretches.push_back({});
      stretches.back().lower = axis[i];
    }
    stretches.back().low = stretches.back().high = i;
  }
  return stretches;
}

}  // namespace umbrick
