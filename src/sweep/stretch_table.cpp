// SPDX-License-Identifier: Apache-2.0
#include "sweep/stretch_table.h"

#include <algorithm>

#include "umbrick/optics/transfer_stretches.h"

namespace umbrick {

StretchTable::StretchTable(const TransferFunction& transfer, const std::function<double(double)>& stepsOf, int steps,
                           double most) {
  // What lies beyond is no number of steps any more; differences of these stay finite.
  constexpr double kFar = 1e30;
  const auto bounded = [&](double at) { return static_cast<float>(std::clamp(at, -kFar, kFar)); };
  const std::vector<AxisStretch> stretches = axisStretches(transfer.values());
  for (const AxisStretch& stretch : stretches) {
    const Medium &low = transfer.media()[stretch.low], &high = transfer.media()[stretch.high];
    const auto sigma = [&](const Medium& medium) { return static_cast<float>(std::min(medium.sigma_t, most)); };
    numbers_.insert(numbers_.end(),
                    {bounded(stepsOf(stretch.lower)), bounded(stepsOf(stretch.upper)), sigma(low), sigma(high)});
    for (const Medium* medium : {&low, &high})
      for (int c = 0; c < 3; ++c) numbers_.push_back(static_cast<float>(medium->albedo[c]));
    numbers_.resize((numbers_.size() + kNumbers - 1) / kNumbers * kNumbers);
  }
  stretchAt_.resize(static_cast<std::size_t>(steps) + 1);
  std::int32_t number = 0;
  for (int step = 0; step <= steps; ++step) {
    while (number + 1 < count() &&
           static_cast<float>(step) >= numbers_[static_cast<std::size_t>(number * kNumbers + 1)])
      ++number;
    stretchAt_[static_cast<std::size_t>(step)] = number;
  }
}

}  // namespace umbrick
