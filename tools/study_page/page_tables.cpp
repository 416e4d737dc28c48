// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "core/json_writer.h"
#include "study_page/page.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/study/case_scene.h"

namespace umbrick::tools {
namespace {

using Cell = HtmlTable::Cell;

Cell text(const std::string& html) { return {html, "", true}; }
Cell words(const std::string& plain) { return text(escapeHtml(plain)); }
Cell numberCell(double value) { return {printShort(value), jsonNumber(std::isfinite(value) ? value : 1e300), false}; }
// Returns a cell with enough digits, since many a good picture has 0.99-something.
Cell similarity(const std::optional<double>& ssim) {
  if (!ssim) return {"-", "-2", false};
  char text[32];
  std::snprintf(text, sizeof text, "%.4f", *ssim);
  return {text, jsonNumber(*ssim), false};
}
Cell optionalNumber(const std::optional<double>& value) {
  return value ? numberCell(*value) : Cell{"-", "1e300", false};
}

// Returns a cell such as "2.31", which shows the spread when the pointer is over it.
Cell timeCell(const Spread& time) {
  return {"<span title=\"quartiles " + printShort(time.lowerQuartile) + " to " + printShort(time.upperQuartile) +
              ", extremes " + printShort(time.least) + " to " + printShort(time.most) + "\">" +
              printShort(time.median) + "</span>",
          jsonNumber(time.median), false};
}

std::vector<Cell> heads(const std::vector<std::string>& names, std::size_t texts) {
  std::vector<Cell> cells;
  for (const std::string& name : names) cells.push_back({name, "", cells.size() < texts});
  return cells;
}

void appendError(std::vector<Cell>& cells, const ErrorMeasures& error) {
  cells.insert(cells.end(), {numberCell(error.rmse), numberCell(error.p999), numberCell(error.maxError),
                             numberCell(error.relMse), similarity(error.ssim), optionalNumber(error.flip)});
}

const std::vector<std::string> kErrorHeads{"RMSE", "99.9 %", "max", "relMSE", "SSIM", "FLIP"};

std::vector<std::string> withErrorHeads(std::vector<std::string> names) {
  names.insert(names.end(), kErrorHeads.begin(), kErrorHeads.end());
  return names;
}

std::string linked(const StudyCase& what, const StudyPlan& plan) {
  return "<a href=\"#c-" + what.id() + "\">" + escapeHtml(describeCase(what, plan)) + "</a>";
}

// A value of a case that is not the base's.
struct Variation {
  std::string field, value;  // "segments per slab", "4 segments per slab"
};
std::vector<Variation> variationsOf(const StudyCase& what, const StudyPlan& plan) {
  std::vector<Variation> all;
  const StudyMethod& method = studyMethod(what.method);
  const bool occlusion = traitsOf(method.model).occlusion;
  const StudyCase& base = plan.bases.at(what.method);
  if (what.slices != base.slices) all.push_back({"slices", std::to_string(what.slices) + " slices"});
  if (!method.detail.name.empty() && what.detail != base.detail)
    all.push_back({method.detail.name, method.detail.symbol + " = " + std::to_string(what.detail)});
  if (what.segments != base.segments) all.push_back({"segments", describeSegments(what.segments)});
  const std::string eye = std::to_string(what.bits.eye);
  if (what.bits.eye != plan.baseBits.eye || (occlusion && what.bits.occlusion != plan.baseBits.occlusion))
    all.push_back({"bits", occlusion ? eye + "/" + std::to_string(what.bits.occlusion) + " bits" : eye + " bits"});
  if (what.size != plan.baseSize) all.push_back({"size", std::to_string(what.size) + " pixels high"});
  if (occlusion && what.theta != plan.baseTheta)
    all.push_back({"theta", "theta " + jsonDegrees(what.theta) + " degrees"});
  if (what.scale != base.scale)
    all.push_back({"scale", jsonNumber(what.scale) + (what.scale == 1 ? " texel per voxel" : " texels per voxel")});
  return all;
}

}  // namespace

std::string describeSegments(int segments) {
  if (segments == kAutomaticSegments) return "segments of at most " + printShort(kSegmentVoxels) + " voxels";
  return std::to_string(segments) + (segments == 1 ? " segment" : " segments") + " per slab";
}

std::string describeCase(const StudyCase& what, const StudyPlan& plan) {
  const StudyMethod& method = studyMethod(what.method);
  std::string name = method.title;
  if (!method.detail.name.empty()) name += ", " + method.detail.symbol + " = " + std::to_string(what.detail);
  name += ", " + std::to_string(what.slices) + (what.slices == 1 ? " slice" : " slices");
  for (const Variation& one : variationsOf(what, plan)) {
    if (one.field == "slices" || one.field == method.detail.name) continue;
    name += ", " + one.value;
  }
  return name;
}

std::string frontTable(const StudyRecord& record, const ComparableCases& group) {
  HtmlTable table;
  table.head = heads(withErrorHeads({"cheapest first", "time"}), 1);
  for (const CaseResult* result : group.front) {
    HtmlTable::Row row{{text(linked(result->what, record.plan)), timeCell(result->timeRatio)}};
    appendError(row.cells, result->error);
    table.rows.push_back(row);
  }
  return printHtml(table);
}

std::string earlierTable(const StudyRecord& record, Model model) {
  if (!record.earlier) return {};
  const std::string of =
      "<code>" + escapeHtml(record.earlier->name) + "</code> (umbrick " + escapeHtml(record.earlier->version) + ")";
  HtmlTable table;
  table.head = heads({"earlier, cheapest first", "time", "RMSE"}, 1);
  for (const EarlierCase& one : record.earlier->comparable(record, model))
    table.rows.push_back({{words(one.id), numberCell(one.timeRatio), numberCell(one.rmse)}});
  if (table.rows.empty()) return "<p class=\"quiet\">" + of + " has no case of this model, size and theta.</p>\n";
  return "<p class=\"quiet\">The Pareto front of " + of +
         ", grey in the plot. Its times are multiples of its own baseline.</p>\n" + printHtml(table);
}

std::string aroundBaseTable(const StudyRecord& record) {
  HtmlTable table;
  table.head = heads(withErrorHeads({"method", "varied", "time"}), 2);
  for (const std::string& name : record.plan.settings.methods) {
    bool first = true;
    for (const StudyCase& what : record.plan.cases) {
      const CaseResult* result = record.find(what);
      const std::vector<Variation> variations = variationsOf(what, record.plan);
      if (!result || what.method != name || variations.size() > 1) continue;
      const Variation variation = variations.empty() ? Variation{"", "base point"} : variations.front();
      // Slices and detail have plots of their own.
      if (!variations.empty() && (variation.field == "slices" || variation.field == studyMethod(name).detail.name))
        continue;
      HtmlTable::Row row{
          {words(first ? studyMethod(name).title : ""), words(variation.value), timeCell(result->timeRatio)},
          first ? "new" : ""};
      appendError(row.cells, result->error);
      table.rows.push_back(row);
      first = false;
    }
  }
  if (table.rows.empty()) return {};
  return "<p>One thing changed at a time. A picture of another size or theta is compared with a reference of its own, "
         "and its time with a baseline of its size.</p>\n" +
         printHtml(table);
}

std::string modelErrorTable(const StudyRecord& record) {
  if (record.modelErrors.empty()) return {};
  HtmlTable table;
  table.head = heads(withErrorHeads({"theta, degrees", "size"}), 0);
  for (const ModelError& error : record.modelErrors) {
    HtmlTable::Row row{{{jsonDegrees(error.cone.theta)}, {std::to_string(error.cone.size)}}};
    appendError(row.cells, error.error);
    table.rows.push_back(row);
  }
  return "<p>What the model leaves out: the reference with light from the cone alone against the reference with light "
         "from the whole sphere (Fig. 2 of <a href=\"https://doi.org/10.1111/j.1467-8659.2009.01464.x\">Schott et al. "
         "2009</a>). No method can make this error smaller, and no method error contains it.</p>\n" +
         printHtml(table);
}

std::string comparisonTables(const StudyRecord& record, const std::vector<ComparableCases>& groups) {
  HtmlTable reached;
  reached.head = heads({"speed-up", "dos", "time", "RMSE", "ordinates", "time", "RMSE"}, 0);
  reached.head[1].text = reached.head[4].text = true;
  for (const ComparableCases& group : groups) {
    if (!traitsOf(group.model).cone || group.size != record.plan.baseSize) continue;
    bool first = true;
    for (const Comparison& one : fastestOfNoLargerError(group)) {
      HtmlTable::Row row{
          {one.with ? numberCell(one.speedup()) : Cell{"-"}, text(linked(one.without->what, record.plan)),
           timeCell(one.without->timeRatio), numberCell(one.without->error.rmse)},
          first ? "new" : ""};
      if (one.with)
        row.cells.insert(row.cells.end(), {text(linked(one.with->what, record.plan)), timeCell(one.with->timeRatio),
                                           numberCell(one.with->error.rmse)});
      else
        row.cells.insert(row.cells.end(), {words("not reached"), {"-"}, {"-"}});
      reached.rows.push_back(row);
      first = false;
    }
  }
  std::string html;
  if (!reached.rows.empty())
    html +=
        "<p>For every error that <code>dos</code> reaches, the fastest case of <code>ordinates</code> whose error is "
        "no larger, at each theta. Left is the Pareto front of <code>dos</code>: its other cases are slower than one "
        "of these with no larger error.</p>\n" +
        printHtml(reached);
  HtmlTable few;
  few.head = heads({"ordinates", "dos", "times as fast", "times the RMSE"}, 2);
  for (const Comparison& one : fewBesideMany(record))
    few.rows.push_back({{text(linked(one.with->what, record.plan)), text(linked(one.without->what, record.plan)),
                         numberCell(one.speedup()), numberCell(one.errorRatio())}});
  if (!few.rows.empty())
    html += "<p>Few directions in few slices beside <code>dos</code> in " + std::to_string(kManySlices) +
            " slices.</p>\n" + printHtml(few);
  return html;
}

std::string windowTable(const StudyRecord& record) {
  HtmlTable table;
  table.sortable = true;
  table.head =
      heads({"case", "time", "RMSE", "segments", "texel", "MiB", "updates, M", "fragments, M", "passes, %"}, 1);
  for (const StudyCase& what : record.plan.cases) {
    const CaseResult* result = record.find(what);
    if (!result || !studyMethod(what.method).windows) continue;
    HtmlTable::Row row{{text(linked(what, record.plan)),
                        timeCell(result->timeRatio),
                        numberCell(result->error.rmse),
                        {std::to_string(result->segments)},
                        numberCell(result->windowTexel),
                        numberCell(static_cast<double>(result->windowBytes) / (1 << 20)),
                        numberCell(1e-6 * static_cast<double>(result->windowUpdates)),
                        numberCell(1e-6 * static_cast<double>(result->fragments))}};
    std::string passes;
    for (const double share : passShares(result->passes))
      passes += (passes.empty() ? "" : " / ") + std::to_string(std::lround(100 * share));
    row.cells.push_back({passes, jsonNumber(passShares(result->passes)[1]), false});
    table.rows.push_back(row);
  }
  if (table.rows.empty()) return {};
  return "<p>The edge of a texel of the windows in world units; what the windows and the slices that they light take "
         "in "
         "memory; how many texels slices were taken through, and fragments of bricks for light and eye, in millions; "
         "and how the time of the sweep divides over extinction of the slices / light through the windows / what the "
         "eye sees. Fragments and passes are those of a picture of its own, which is not timed.</p>\n" +
         printHtml(table);
}

std::string caseTable(const StudyRecord& record, const std::vector<ComparableCases>& groups) {
  const std::set<const CaseResult*> front = frontCases(groups);
  const bool milliseconds = !record.machine.software;
  HtmlTable table;
  table.sortable = true;
  std::vector<std::string> names{"method", "detail", "slices", "segments", "bits", "size", "theta", "time"};
  if (milliseconds) names.push_back("ms");
  table.head = heads(withErrorHeads(names), 2);
  for (const StudyCase& what : record.plan.cases) {
    const CaseResult* result = record.find(what);
    if (!result) continue;
    const StudyMethod& method = studyMethod(what.method);
    const bool occlusion = traitsOf(method.model).occlusion;
    HtmlTable::Row row;
    if (front.contains(result)) row.kind = "front";
    row.cells = {text("<a href=\"#c-" + what.id() + "\">" + escapeHtml(what.method) + "</a>"),
                 words(method.detail.name.empty() ? "" : method.detail.symbol + " = " + std::to_string(what.detail)),
                 {std::to_string(what.slices)},
                 {std::to_string(result->segments)},
                 {std::to_string(what.bits.eye) + (occlusion ? "/" + std::to_string(what.bits.occlusion) : "")},
                 {std::to_string(what.size)},
                 {occlusion ? jsonDegrees(what.theta) : ""},
                 timeCell(result->timeRatio)};
    if (milliseconds) row.cells.push_back(numberCell(result->caseMs));
    appendError(row.cells, result->error);
    table.rows.push_back(row);
  }
  if (table.rows.empty()) return {};
  return "<p>Shaded rows are on the Pareto front of their model, size and theta. Times are multiples of the baseline; "
         "hover for their spread. Bits are those of the eye and the occlusion buffer. A click on a head sorts. The "
         "same numbers are in <code>study.csv</code>.</p>\n" +
         printHtml(table);
}

std::string referenceTable(const StudyRecord& record) {
  if (record.references.empty()) return {};
  HtmlTable table;
  table.head = heads(withErrorHeads({"reference", "size", "theta", "time"}), 1);
  for (const ReferenceResult& result : record.references) {
    HtmlTable::Row row{
        {words(result.what.look == StudyLook::medium ? modelName(result.what.model) : lookName(result.what.look)),
         {std::to_string(result.what.size)},
         {traitsOf(result.what.model).cone ? jsonDegrees(result.what.theta) : ""},
         numberCell(result.timeRatio)}};
    appendError(row.cells, result.coarser);
    table.rows.push_back(row);
  }
  return "<p><b>References.</b> Their times are single runs, as multiples of the baseline before and after; their "
         "errors are differences to the coarser one.</p>\n" +
         printHtml(table);
}

}  // namespace umbrick::tools
