// The section of a page that says which method to take: the fastest for an error, its memory, and its picture.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <vector>

#include "core/json_writer.h"
#include "study_page/page.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick::tools {
namespace {

using Cell = HtmlTable::Cell;

// Returns a cell that leads to the commands of the case.
Cell timeOf(const ErrorReached& reached, const ErrorReached::Way& way, const StudyPlan& plan) {
  if (!way.fastest) return {"-", "1e300", false};
  const double time = reached.time(*way.fastest);
  std::string html = "<a href=\"#c-" + way.fastest->what.id() + "\" title=\"" +
                     escapeHtml(describeCase(way.fastest->what, plan)) + ", RMSE " +
                     printShort(way.fastest->error.rmse) + "\">" + printShort(time) + "</a>";
  if (reached.best() == &way) html = "<b>" + html + "</b>";
  return {html, jsonNumber(time), false};
}

double megabytes(const CaseResult& result) {
  return static_cast<double>(result.bufferBytes + result.textureBytes) / (1 << 20);
}

// Returns the most that a method takes at any of the errors.
double memoryOf(const StudyMethod* method, const std::vector<ErrorReached>& all) {
  double most = 0;
  for (const ErrorReached& reached : all)
    for (const ErrorReached::Way& way : reached.ways)
      if (way.method == method && way.fastest) most = std::max(most, megabytes(*way.fastest));
  return most;
}

// Says of each error which method is the fastest, and how far the next one is behind.
std::string verdicts(const std::vector<ErrorReached>& all) {
  std::string html = "<ul>\n";
  for (const ErrorReached& reached : all) {
    const ErrorReached::Way* best = reached.best();
    if (!best) continue;
    html += "<li>Off by at most " + printShort(reached.error) + ": <b>" + escapeHtml(best->method->title) + "</b>";
    const ErrorReached::Way* next = nullptr;
    for (const ErrorReached::Way& way : reached.ways)
      if (way.fastest && &way != best && (!next || reached.time(*way.fastest) < reached.time(*next->fastest)))
        next = &way;
    if (next)
      html += ", " + printShort(reached.time(*next->fastest) / reached.time(*best->fastest)) + " times as fast as " +
              escapeHtml(next->method->title);
    html += ".</li>\n";
  }
  return html + "</ul>\n";
}

std::string table(const std::vector<ErrorReached>& all, const StudyPlan& plan) {
  HtmlTable table;
  table.head.push_back({"time for an RMSE of at most", "", true});
  for (const ErrorReached& reached : all) table.head.push_back({printShort(reached.error)});
  table.head.push_back({"MiB"});
  for (std::size_t i = 0; i < all.front().ways.size(); ++i) {
    const StudyMethod* method = all.front().ways[i].method;
    HtmlTable::Row row{{{escapeHtml(method->title), "", true}}};
    for (const ErrorReached& reached : all) row.cells.push_back(timeOf(reached, reached.ways[i], plan));
    const double memory = memoryOf(method, all);
    row.cells.push_back({memory > 0 ? printShort(memory) : "-"});
    table.rows.push_back(row);
  }
  return printHtml(table);
}

bool computesLight(const ComparableCases& group) {
  return std::any_of(group.all.begin(), group.all.end(), [](const CaseResult* one) { return one->lightMs > 0; });
}

}  // namespace

std::string whichWhenTables(const StudyRecord& record, const std::vector<ComparableCases>& groups) {
  std::string html;
  for (const Model model : {Model::cone, Model::emission}) {
    const ComparableCases* group = baseGroup(groups, record.plan, model);
    if (!group) continue;
    const bool light = computesLight(*group);
    for (const bool withLight : {true, false}) {
      if (withLight && !light) continue;
      const std::vector<ErrorReached> all = errorsReached(*group, withLight);
      if (all.empty() || all.front().ways.size() < 2) continue;
      const std::string kind = !light      ? ""
                               : withLight ? ", light computed for the picture"
                                           : ", light kept from the picture before";
      html += "<h3>" + modelName(model) + kind + "</h3>\n" + verdicts(all) + table(all, record.plan);
    }
  }
  if (html.empty()) return {};
  return "<p>Each number is the time of the method's fastest case that is off by no more, as a multiple of the "
         "baseline; the fastest of all is bold, a dash is an error that no case reaches. Light volumes are computed "
         "when light, medium or cuts change, and for a cone also when the camera turns; while they are kept, a picture "
         "costs what the second table says. MiB are those of bricks, light and buffers, the most of a row. Which "
         "errors are reached depends on the slices that were swept.</p>\n" +
         html;
}

}  // namespace umbrick::tools
