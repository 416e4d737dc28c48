// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/study_findings.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "study/invented_study.h"

using namespace umbrick;

namespace {

bool isWith(const CaseResult& result) { return studyMethod(result.what.method).windows; }

}  // namespace

TEST_CASE("The fastest case with windows of no larger error is found for every error reached without windows",
          "[report]") {
  const StudyRecord record = inventedStudy();
  std::size_t found = 0;
  for (const ComparableCases& group : comparableCases(record)) {
    const std::vector<Comparison> all = fastestOfNoLargerError(group);
    CHECK(all.empty() == (group.model != Model::cone));
    for (const Comparison& one : all) {
      REQUIRE(one.without);
      CHECK(!isWith(*one.without));
      // The expected case follows from the definition, over all pairs.
      const CaseResult* best = nullptr;
      for (const CaseResult* other : group.all) {
        if (!isWith(*other)) {
          const bool better =
              other->timeRatio.median < one.without->timeRatio.median && other->error.rmse <= one.without->error.rmse;
          CHECK(!better);
        } else if (other->error.rmse <= one.without->error.rmse &&
                   (!best || other->timeRatio.median < best->timeRatio.median)) {
          best = other;
        }
      }
      CHECK(one.with == best);
      if (best) ++found;
    }
    // Cases off the front are no better than a case on it.
    if (all.empty()) continue;
    for (const CaseResult* other : group.all)
      if (!isWith(*other))
        CHECK(std::any_of(all.begin(), all.end(), [&](const Comparison& one) {
          return one.without->error.rmse <= other->error.rmse &&
                 one.without->timeRatio.median <= other->timeRatio.median;
        }));
  }
  CHECK(found > 0);
}

TEST_CASE("An error that no case with windows reaches has no fastest case", "[report]") {
  StudyRecord record = inventedStudy();
  for (CaseResult& result : record.cases)
    if (isWith(result)) result.error.rmse = 1;
  for (const ComparableCases& group : comparableCases(record))
    for (const Comparison& one : fastestOfNoLargerError(group)) CHECK(one.with == nullptr);
}

TEST_CASE("Few directions in few slices are compared with many slices where both are there", "[report]") {
  CHECK(fewBesideMany(inventedStudy()).empty());
  StudyRecord record = inventedStudy({8, 64, 128, 1024});
  const std::vector<Comparison> all = fewBesideMany(record);
  CHECK(all.size() == 2 * 2);  // 64 and 128 slices, two footprints
  for (const Comparison& one : all) {
    CHECK(one.with->what.detail == kFewDirections);
    CHECK(one.without->what.slices == kManySlices);
    CHECK(one.speedup() == one.without->timeRatio.median / one.with->timeRatio.median);
    CHECK(one.errorRatio() == one.with->error.rmse / one.without->error.rmse);
  }
}

TEST_CASE("The fastest case of each method is found for each error that some reach, with light and without",
          "[report]") {
  StudyRecord record = inventedStudy();
  // Light of its own makes the cases of one method slower, by different amounts.
  for (CaseResult& result : record.cases)
    if (isWith(result)) result.lightMs = result.baselineMs * (5 + result.what.slices);
  std::size_t found = 0;
  for (const ComparableCases& group : comparableCases(record))
    for (const bool withLight : {false, true}) {
      const auto time = [&](const CaseResult& one) {
        return one.timeRatio.median + (withLight ? one.lightMs / one.baselineMs : 0);
      };
      for (const ErrorReached& reached : errorsReached(group, withLight)) {
        CHECK(std::any_of(group.all.begin(), group.all.end(),
                          [&](const CaseResult* one) { return one->error.rmse <= reached.error; }));
        CHECK(std::any_of(group.all.begin(), group.all.end(),
                          [&](const CaseResult* one) { return one->error.rmse > reached.error; }));
        double fastest = 1e300;
        for (const ErrorReached::Way& way : reached.ways) {
          const CaseResult* expected = nullptr;
          for (const CaseResult* one : group.all)
            if (one->what.method == way.method->name && one->error.rmse <= reached.error &&
                (!expected || time(*one) < time(*expected)))
              expected = one;
          CHECK(way.fastest == expected);
          if (expected) fastest = std::min(fastest, time(*expected));
        }
        REQUIRE(reached.best());
        CHECK(reached.time(*reached.best()->fastest) == fastest);
        ++found;
      }
    }
  CHECK(found > 4);
  CHECK(errorsReached(ComparableCases{}, true).empty());
}
