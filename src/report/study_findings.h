// What follows from the measurements of a study: who is on the Pareto front, the orders of convergence.
#pragma once
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "report/study_record.h"

namespace umbrick {

/// The cases that are comparable in time and error: of one model, size and theta.
struct ComparableCases {
  Model model = Model::emission;
  int size = 0;
  double theta = 0;
  std::vector<const CaseResult*> all;
  std::vector<const CaseResult*> front;  // Pareto front of time ratio and RMSE, cheapest first
};

/// Groups in the order of the plan, of the cases that are measured. Valid as long as the record.
std::vector<ComparableCases> comparableCases(const StudyRecord& record);

/// All that are on a front, but for cases that nothing compares with.
std::set<const CaseResult*> frontCases(const std::vector<ComparableCases>& groups);

/// The group at the base size (and theta); nothing measured: none.
const ComparableCases* baseGroup(const std::vector<ComparableCases>& groups, const StudyPlan& plan, Model model);

/// Cases of one method and detail that differ in their slices alone, coarsest first.
struct SliceSeries {
  std::string title;  // "dos, Algorithm 3, n = 3"
  const StudyMethod* method = nullptr;
  int detail = 0;
  std::vector<const CaseResult*> cases;
  /// p of RMSE = c d^p by least squares, over the cases whose error is above twice that of the reference.
  std::optional<double> order;
};

/// At the base of everything else.
std::vector<SliceSeries> sliceSeries(const StudyRecord& record, Model model);

/// RMSE between the reference and its coarser self; 0: not measured.
double referenceError(const StudyRecord& record, const StudyReference& reference);

}  // namespace umbrick
