// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/study_table.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "core/json_writer.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/study/case_scene.h"
#include "umbrick/study/study_findings.h"

namespace umbrick {
namespace {

std::string cell(double value) { return std::isfinite(value) ? jsonNumber(value) : "inf"; }
std::string cell(const std::optional<double>& value) { return value ? cell(*value) : ""; }

std::string row(const std::vector<std::string>& cells) {
  std::string text;
  for (std::size_t i = 0; i < cells.size(); ++i) text += (i > 0 ? "," : "") + cells[i];
  return text + "\n";
}

std::vector<std::string> header(bool milliseconds) {
  std::vector<std::string> names{"id",
                                 "method",
                                 "slices",
                                 "segments",
                                 "detail_name",
                                 "detail",
                                 "eye_bits",
                                 "occlusion_bits",
                                 "width",
                                 "height",
                                 "theta_degrees",
                                 "spacing_world",
                                 "slices_drawn",
                                 "time_ratio",
                                 "time_ratio_lower_quartile",
                                 "time_ratio_upper_quartile",
                                 "time_ratio_min",
                                 "time_ratio_max",
                                 "pairs",
                                 "rmse",
                                 "max_error",
                                 "p99_9",
                                 "rel_mse",
                                 "ssim",
                                 "flip",
                                 "pareto_front",
                                 "reference",
                                 "reference_error_rmse"};
  names.insert(names.end(), {"window_scale", "window_texel_world", "window_bytes", "window_updates", "fragments",
                             "extinction_share", "windows_share", "eye_share", "time_ratio_with_light"});
  if (milliseconds) names.insert(names.end(), {"case_ms", "baseline_ms"});
  return names;
}

std::vector<std::string> cells(const StudyRecord& record, const CaseResult& result, bool onFront) {
  const StudyCase& what = result.what;
  const StudyMethod& method = studyMethod(what.method);
  const bool occlusion = traitsOf(method.model).occlusion, hasDetail = !method.detail.name.empty();
  const StudyReference reference = record.plan.referenceOf(what);
  const Camera camera = referenceScene(record.scene, reference).camera;
  std::vector<std::string> values{what.id(),
                                  what.method,
                                  std::to_string(what.slices),
                                  std::to_string(result.segments),
                                  method.detail.name,
                                  hasDetail ? std::to_string(what.detail) : "",
                                  std::to_string(what.bits.eye),
                                  occlusion ? std::to_string(what.bits.occlusion) : "",
                                  std::to_string(camera.width),
                                  std::to_string(camera.height),
                                  occlusion ? jsonDegrees(what.theta) : "",
                                  cell(result.spacing),
                                  std::to_string(result.slicesDrawn),
                                  cell(result.timeRatio.median),
                                  cell(result.timeRatio.lowerQuartile),
                                  cell(result.timeRatio.upperQuartile),
                                  cell(result.timeRatio.least),
                                  cell(result.timeRatio.most),
                                  std::to_string(result.pairs),
                                  cell(result.error.rmse),
                                  cell(result.error.maxError),
                                  cell(result.error.p999),
                                  cell(result.error.relMse),
                                  cell(result.error.ssim),
                                  cell(result.error.flip),
                                  onFront ? "1" : "0",
                                  reference.id(),
                                  cell(referenceError(record, reference))};
  if (method.windows)
    values.insert(values.end(), {what.scale > 0 ? cell(what.scale) : "auto", cell(result.windowTexel),
                                 std::to_string(result.windowBytes), std::to_string(result.windowUpdates)});
  else
    values.insert(values.end(), 4, "");
  values.push_back(std::to_string(result.fragments));
  for (const double share : passShares(result.passes)) values.push_back(cell(share));
  values.push_back(cell(timeWithLight(result)));
  if (!record.machine.software) {
    values.push_back(cell(result.caseMs));
    values.push_back(cell(result.baselineMs));
  }
  return values;
}

}  // namespace

std::string printTable(const StudyRecord& record) {
  const std::set<const CaseResult*> front = frontCases(comparableCases(record));
  std::string text = row(header(!record.machine.software));
  for (const StudyCase& what : record.plan.cases)
    if (const CaseResult* result = record.find(what)) text += row(cells(record, *result, front.contains(result)));
  return text;
}

}  // namespace umbrick
