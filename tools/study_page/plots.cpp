// SPDX-License-Identifier: Apache-2.0
#include "study_page/plots.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <vector>

#include "umbrick/scene/capabilities.h"
#include "umbrick/study/study_findings.h"

namespace umbrick::tools {
namespace {

const char* const kErrorLabel = "RMSE against the reference";

std::string modelSuffix(Model model) { return "-" + modelName(model); }

PlotPoint timePoint(const CaseResult& result) {
  return {
      result.timeRatio.median, result.error.rmse, result.timeRatio.lowerQuartile, result.timeRatio.upperQuartile, {}};
}

void addFloor(Plot& plot, const StudyRecord& record, Model model) {
  const double theta = !traitsOf(model).occlusion ? 0 : record.plan.baseTheta;
  const double floor = referenceError(record, {model, record.plan.baseSize, theta});
  if (floor > 0) plot.levels.push_back({"error of the reference", floor});
}

std::string withOrder(const SliceSeries& series) {
  if (!series.order) return series.title;
  char text[32];
  std::snprintf(text, sizeof text, ": order %.2f", *series.order);
  return series.title + text;
}

// Returns a colour per method, the same in all plots.
int familyOf(const SliceSeries& series, const StudyRecord& record) {
  int family = 0;
  for (const std::string& name : record.plan.settings.methods) {
    const StudyMethod& method = studyMethod(name);
    if (&method == series.method) break;
    if (method.model == series.method->model) ++family;
  }
  return family;
}

}  // namespace

Plot paretoPlot(const StudyRecord& record, Model model) {
  Plot plot;
  plot.name = "pareto" + modelSuffix(model);
  plot.xLabel = "time, as a multiple of the baseline";
  plot.yLabel = kErrorLabel;
  const std::vector<ComparableCases> groups = comparableCases(record);
  const ComparableCases* group = baseGroup(groups, record.plan, model);
  if (!group) return plot;
  std::set<const CaseResult*> shown;
  std::set<std::vector<int>> labelled;
  for (const SliceSeries& series : sliceSeries(record, model)) {
    PlotSeries line{series.title, PlotStyle::line, {}, true, familyOf(series, record)};
    // Only one of the lines with the same numbers of slices has labels.
    const bool first = labelled.insert(record.plan.slices.at(series.method->name)).second;
    for (const CaseResult* result : series.cases) {
      line.points.push_back(timePoint(*result));
      if (first) line.points.back().label = "N=" + std::to_string(result->what.slices);
      shown.insert(result);
    }
    plot.series.push_back(line);
  }
  PlotSeries others{"other bits, segments or scales", PlotStyle::points, {}, false};
  for (const CaseResult* result : group->all)
    if (!shown.contains(result)) others.points.push_back(timePoint(*result));
  plot.series.push_back(others);
  PlotSeries front{"Pareto front", PlotStyle::front, {}, false};
  for (const CaseResult* result : group->front) front.points.push_back(timePoint(*result));
  plot.series.push_back(front);
  if (record.earlier) {
    PlotSeries before{"earlier Pareto front", PlotStyle::earlier, {}, false};
    for (const EarlierCase& one : record.earlier->comparable(record, model))
      before.points.push_back({one.timeRatio, one.rmse, 0, 0, {}});
    plot.series.push_back(before);
  }
  addFloor(plot, record, model);
  return plot;
}

Plot convergencePlot(const StudyRecord& record, Model model) {
  Plot plot;
  plot.name = "convergence" + modelSuffix(model);
  plot.xLabel = "d: distance of slices, world units";
  plot.yLabel = kErrorLabel;
  for (const SliceSeries& series : sliceSeries(record, model)) {
    PlotSeries line{!traitsOf(model).occlusion ? withOrder(series) : series.title,
                    PlotStyle::line,
                    {},
                    false,
                    familyOf(series, record)};
    for (const CaseResult* result : series.cases)
      line.points.push_back({result->spacing, result->error.rmse, 0, 0, {}});
    plot.series.push_back(line);
  }
  addFloor(plot, record, model);
  return plot;
}

Plot detailPlot(const StudyRecord& record, const StudyMethod::Detail& detail) {
  Plot plot;
  plot.name = "detail-" + detail.name;
  plot.xLabel = detail.symbol + ": " + detail.meaning;
  plot.yLabel = kErrorLabel;
  plot.wholeX = true;
  // There is a line for each method and number of slices, from all slice series of the method.
  for (const std::string& name : record.plan.settings.methods) {
    const StudyMethod& method = studyMethod(name);
    if (method.detail.name != detail.name) continue;
    const std::vector<SliceSeries> series = sliceSeries(record, method.model);
    for (const int slices : record.plan.slices.at(name)) {
      PlotSeries line{method.title + ", N = " + std::to_string(slices), PlotStyle::line, {}, false};
      for (const SliceSeries& one : series)
        for (const CaseResult* result : one.cases)
          if (one.method == &method && result->what.slices == slices)
            line.points.push_back({static_cast<double>(one.detail), result->error.rmse, 0, 0, {}});
      if (line.points.size() > 1) plot.series.push_back(line);
    }
  }
  return plot;
}

}  // namespace umbrick::tools
