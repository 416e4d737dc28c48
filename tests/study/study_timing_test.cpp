// SPDX-License-Identifier: Apache-2.0
#include "study/study_timing.h"

#include <catch2/catch.hpp>
#include <string>

using namespace umbrick;

TEST_CASE("Baseline and case take turns, and the first of each does not count", "[report]") {
  std::string order;
  TimingOptions options;
  options.pairs = 3;
  options.enoughMs = 0;
  const PairedTimes times = timePairs([&] { order += 'b'; }, [&] { order += 'c'; }, options);
  CHECK(order == "bcbcbcbc");
  CHECK(times.baselineMs.size() == 3);
  CHECK(times.caseMs.size() == 3);
}

TEST_CASE("Short cases are timed more often, up to a limit", "[report]") {
  int cases = 0;
  TimingOptions options;
  options.pairs = 2;
  options.enoughMs = 1e9;  // never
  options.mostPairs = 9;
  const PairedTimes times = timePairs([] {}, [&] { ++cases; }, options);
  CHECK(times.caseMs.size() == 9);
  CHECK(cases == 10);
}
