// Finds what follows from the measurements of a study: which cases are on the Pareto front, and the orders of
// convergence. All findings point into the record that they were made from, and are valid as long as it stays as it is.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "umbrick/study/study_record.h"

namespace umbrick {

/// The cases of one model, size, theta and look, which are comparable in time and error.
struct ComparableCases {
  Model model = Model::emission;
  int size = 0;      // height of the picture, pixels
  double theta = 0;  // rad; 0 for emission
  StudyLook look = StudyLook::medium;
  std::vector<const CaseResult*> all;
  std::vector<const CaseResult*> front;  // Pareto front of time ratio and RMSE, cheapest first
};

/// Returns the measured cases in groups, in the order of the plan.
std::vector<ComparableCases> comparableCases(const StudyRecord& record);

/// Returns all cases that are on the front of their group, except cases that are alone in their group.
std::set<const CaseResult*> frontCases(const std::vector<ComparableCases>& groups);

/// Returns the group of a model and a look at the base size (and theta); null when none of its cases is measured.
const ComparableCases* baseGroup(const std::vector<ComparableCases>& groups, const StudyPlan& plan, Model model,
                                 StudyLook look = StudyLook::medium);

/// Cases of one method and detail that differ in their slices alone, coarsest first.
struct SliceSeries {
  std::string title;  // "dos, Algorithm 3, n = 3"
  const StudyMethod* method = nullptr;
  int detail = 0;  // 0 when the method has none
  std::vector<const CaseResult*> cases;
  /// The order p of RMSE = c d^p by least squares, over the cases whose error is more than twice that of the reference.
  std::optional<double> order;
};

/// Returns the series of all methods of a model that show the medium, at the base of everything except slices and
/// detail.
std::vector<SliceSeries> sliceSeries(const StudyRecord& record, Model model);

/// A case of a method with light windows beside one without, of the same model, size and theta.
struct Comparison {
  const CaseResult* without = nullptr;
  const CaseResult* with = nullptr;  // null: none

  /// Returns how many times as fast the case with windows is.
  double speedup() const { return without->timeRatio.median / with->timeRatio.median; }
  /// Returns its error as a multiple of the other's.
  double errorRatio() const { return with->error.rmse / without->error.rmse; }
};

/// Returns a comparison for each case of the Pareto front of the methods without windows, cheapest first: with the
/// fastest case with windows whose error is no larger. Empty when a group lacks one of the two kinds.
std::vector<Comparison> fastestOfNoLargerError(const ComparableCases& group);

/// Returns comparisons of few directions and slices with many slices, at the base of everything else: K = 8 in 64 to
/// 128 slices beside all details of the methods without windows in 1024.
std::vector<Comparison> fewBesideMany(const StudyRecord& record);
inline constexpr int kFewDirections = 8, kFewSlices[2]{64, 128}, kManySlices = 1024;

/// What each method of a group needs for an error.
struct ErrorReached {
  double error = 0;  // RMSE
  struct Way {
    const StudyMethod* method = nullptr;
    const CaseResult* fastest = nullptr;  // of the method's cases that are off by no more; null: none is
  };
  std::vector<Way> ways;                        // of all methods of the group, in the order of studyMethods()
  double (*time)(const CaseResult&) = nullptr;  // by which ways are compared
  const Way* best() const;                      // the fastest of all; null: none
};

/// Returns what the methods of a group need for errors of 0.1, 0.03, 0.01 and so on that some of them reach and not all
/// of their cases. Where `withLight`, each picture has its light computed for it, as after a change of the transfer
/// function or where light turns with the camera; else it is there already.
std::vector<ErrorReached> errorsReached(const ComparableCases& group, bool withLight);

/// Returns the case of least error of each method of a group, in the order of studyMethods().
std::vector<const CaseResult*> finestCases(const ComparableCases& group);

/// Returns the RMSE between the reference and its coarser self; 0: not measured.
double referenceError(const StudyRecord& record, const StudyReference& reference);

}  // namespace umbrick
