// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/study_findings.h"
#include "umbrick/scene/capabilities.h"

#include <algorithm>

namespace umbrick {
namespace {

std::vector<const CaseResult*> frontOf(const std::vector<const CaseResult*>& cases) {
  std::vector<CostAndError> points;
  for (const CaseResult* result : cases) points.push_back({result->timeRatio.median, result->error.rmse});
  std::vector<const CaseResult*> front;
  for (const std::size_t i : paretoFront(points)) front.push_back(cases[i]);
  return front;
}

std::optional<double> observedOrder(const SliceSeries& series, double floor) {
  std::vector<double> spacing, error;
  for (const CaseResult* result : series.cases)
    if (result->error.rmse > 2 * floor) {
      spacing.push_back(result->spacing);
      error.push_back(result->error.rmse);
    }
  return orderOfConvergence(spacing, error);
}

}  // namespace

std::vector<ComparableCases> comparableCases(const StudyRecord& record) {
  std::vector<ComparableCases> groups;
  for (const StudyCase& what : record.plan.cases) {
    const CaseResult* result = record.find(what);
    if (!result) continue;
    const StudyReference reference = record.plan.referenceOf(what);
    auto group = std::find_if(groups.begin(), groups.end(), [&](const ComparableCases& g) {
      return g.model == reference.model && g.size == reference.size && g.theta == reference.theta &&
             g.look == reference.look;
    });
    if (group == groups.end())
      group = groups.insert(groups.end(), {reference.model, reference.size, reference.theta, reference.look, {}, {}});
    group->all.push_back(result);
  }
  for (ComparableCases& group : groups) group.front = frontOf(group.all);
  return groups;
}

std::set<const CaseResult*> frontCases(const std::vector<ComparableCases>& groups) {
  std::set<const CaseResult*> front;
  for (const ComparableCases& group : groups)
    if (group.all.size() > 1) front.insert(group.front.begin(), group.front.end());
  return front;
}

const ComparableCases* baseGroup(const std::vector<ComparableCases>& groups, const StudyPlan& plan, Model model,
                                 StudyLook look) {
  const double theta = !traitsOf(model).occlusion ? 0 : plan.baseTheta;
  const auto at = std::find_if(groups.begin(), groups.end(), [&](const ComparableCases& g) {
    return g.model == model && g.size == plan.baseSize && g.theta == theta && g.look == look;
  });
  return at == groups.end() ? nullptr : &*at;
}

std::vector<SliceSeries> sliceSeries(const StudyRecord& record, Model model) {
  const StudyPlan& plan = record.plan;
  std::vector<SliceSeries> all;
  for (const std::string& name : plan.settings.methods) {
    const StudyMethod& method = studyMethod(name);
    if (method.model != model || method.look != StudyLook::medium) continue;
    const std::vector<int> none{0};
    const StudyCase& base = plan.bases.at(name);
    const bool hasDetail = !method.detail.name.empty();
    for (const int detail : hasDetail ? plan.settings.details.at(method.detail.name) : none) {
      SliceSeries series{method.title, &method, detail, {}, {}};
      if (hasDetail) series.title += ", " + method.detail.symbol + " = " + std::to_string(detail);
      for (const int slices : plan.slices.at(name)) {
        StudyCase what = base;
        what.slices = slices;
        what.detail = detail;
        if (!traitsOf(model).occlusion) {
          what.theta = 0;
          what.bits.occlusion = what.bits.eye;
        }
        if (const CaseResult* result = record.find(what)) series.cases.push_back(result);
      }
      if (series.cases.empty()) continue;
      series.order = observedOrder(series, referenceError(record, plan.referenceOf(series.cases.front()->what)));
      all.push_back(std::move(series));
    }
  }
  return all;
}

std::vector<Comparison> fastestOfNoLargerError(const ComparableCases& group) {
  std::vector<const CaseResult*> with, without;
  for (const CaseResult* result : group.all)
    (studyMethod(result->what.method).windows ? with : without).push_back(result);
  std::vector<Comparison> all;
  if (with.empty()) return all;
  for (const CaseResult* slow : frontOf(without)) {
    Comparison one{slow, nullptr};
    for (const CaseResult* fast : with)
      if (fast->error.rmse <= slow->error.rmse && (!one.with || fast->timeRatio.median < one.with->timeRatio.median))
        one.with = fast;
    all.push_back(one);
  }
  return all;
}

std::vector<Comparison> fewBesideMany(const StudyRecord& record) {
  const std::vector<SliceSeries> all = sliceSeries(record, Model::cone);
  std::vector<Comparison> comparisons;
  for (const SliceSeries& few : all) {
    if (!few.method->windows || few.detail != kFewDirections) continue;
    for (const CaseResult* with : few.cases) {
      if (with->what.slices < kFewSlices[0] || with->what.slices > kFewSlices[1]) continue;
      for (const SliceSeries& many : all)
        for (const CaseResult* without : many.cases)
          if (!many.method->windows && without->what.slices == kManySlices) comparisons.push_back({without, with});
    }
  }
  return comparisons;
}

const ErrorReached::Way* ErrorReached::best() const {
  const Way* best = nullptr;
  for (const Way& way : ways)
    if (way.fastest && (!best || time(*way.fastest) < time(*best->fastest))) best = &way;
  return best;
}

std::vector<ErrorReached> errorsReached(const ComparableCases& group, bool withLight) {
  const auto time = withLight ? timeWithLight : +[](const CaseResult& result) { return result.timeRatio.median; };
  const auto isOff = [](const CaseResult* a, const CaseResult* b) { return a->error.rmse < b->error.rmse; };
  std::vector<ErrorReached> all;
  if (group.all.empty()) return all;
  const auto [least, most] = std::minmax_element(group.all.begin(), group.all.end(), isOff);
  for (const double error : {0.1, 0.03, 0.01, 0.003, 0.001, 0.0003, 0.0001}) {
    if (error < (*least)->error.rmse || error >= (*most)->error.rmse) continue;
    ErrorReached reached{error, {}, time};
    for (const StudyMethod& method : studyMethods()) {
      ErrorReached::Way way{&method, nullptr};
      bool measured = false;
      for (const CaseResult* one : group.all) {
        if (one->what.method != method.name) continue;
        measured = true;
        if (one->error.rmse <= error && (!way.fastest || time(*one) < time(*way.fastest))) way.fastest = one;
      }
      if (measured) reached.ways.push_back(way);
    }
    all.push_back(std::move(reached));
  }
  return all;
}

std::vector<const CaseResult*> finestCases(const ComparableCases& group) {
  std::vector<const CaseResult*> finest;
  for (const StudyMethod& method : studyMethods()) {
    const CaseResult* best = nullptr;
    for (const CaseResult* one : group.all)
      if (one->what.method == method.name && (!best || one->error.rmse < best->error.rmse)) best = one;
    if (best) finest.push_back(best);
  }
  return finest;
}

double referenceError(const StudyRecord& record, const StudyReference& reference) {
  const ReferenceResult* result = record.find(reference);
  return result ? result->coarser.rmse : 0;
}

}  // namespace umbrick
