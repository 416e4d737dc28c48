// Times two jobs by turns, so that whatever else the machine does affects both alike.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <vector>

namespace umbrick {

struct TimingOptions {
  int pairs = 5;          // at least so many
  double enoughMs = 400;  // more pairs follow until all have taken so long together
  int mostPairs = 50;     // no more than so many pairs, or than `pairs`
};

struct PairedTimes {
  std::vector<double> baselineMs, caseMs;  // of the same length: values at the same place are neighbours in time
};

/// Runs baseline, case, baseline, case, ... after one of each that does not count.
PairedTimes timePairs(const std::function<void()>& baseline, const std::function<void()>& other,
                      const TimingOptions& options);

}  // namespace umbrick
