// Timing by turns, so that what else the machine does falls on both alike.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <vector>

namespace umbrick {

struct TimingOptions {
  int pairs = 5;          // at least
  double enoughMs = 400;  // more pairs follow until they have taken so long together,
  int mostPairs = 50;     // but no more than this, or `pairs`
};

struct PairedTimes {
  std::vector<double> baselineMs, caseMs;  // of the same length: neighbours in time
};

/// Runs baseline, case, baseline, case, ... after one of each that does not count.
PairedTimes timePairs(const std::function<void()>& baseline, const std::function<void()>& other,
                      const TimingOptions& options);

}  // namespace umbrick
