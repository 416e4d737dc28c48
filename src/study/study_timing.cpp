// SPDX-License-Identifier: Apache-2.0
#include "study/study_timing.h"

#include <algorithm>
#include <cstddef>

#include "umbrick/core/stopwatch.h"

namespace umbrick {
namespace {

double timeOf(const std::function<void()>& action) {
  const Stopwatch watch;
  action();
  return watch.elapsedMs();
}

}  // namespace

PairedTimes timePairs(const std::function<void()>& baseline, const std::function<void()>& other,
                      const TimingOptions& options) {
  // The first picture uploads bricks and compiles shaders.
  baseline();
  other();
  PairedTimes times;
  double spentMs = 0;
  const auto most = static_cast<std::size_t>(std::max(options.pairs, options.mostPairs));
  while (times.caseMs.size() < static_cast<std::size_t>(options.pairs) ||
         (spentMs < options.enoughMs && times.caseMs.size() < most)) {
    times.baselineMs.push_back(timeOf(baseline));
    times.caseMs.push_back(timeOf(other));
    spentMs += times.baselineMs.back() + times.caseMs.back();
  }
  return times;
}

}  // namespace umbrick
