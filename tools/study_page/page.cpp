// SPDX-License-Identifier: Apache-2.0
#include "study_page/page.h"

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

#include "core/json_writer.h"
#include "core/text_file.h"
#include "study_page/plots.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/core/printable.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/study/case_scene.h"

namespace umbrick {
std::string_view pageText(std::string_view name);  // page.css, page.js
}  // namespace umbrick

namespace umbrick::tools {
namespace {

std::string fact(const std::string& value, const std::string& meaning) {
  return "<div><b>" + escapeHtml(value) + "</b><span>" + escapeHtml(meaning) + "</span></div>\n";
}

std::string section(const std::string& id, const std::string& title, const std::string& body) {
  return body.empty() ? "" : "<h2 id=\"" + id + "\">" + escapeHtml(title) + "</h2>\n" + body;
}

std::string plotFigure(const PageFolder& folder, const Plot& plot, const std::string& caption) {
  if (!drawPlot(folder.plots(), plot)) return {};
  return "<figure class=\"plot\">\n" + inlineSvg(readTextFile(folder.plots() / (plot.name + ".svg")), plot.name) +
         "<figcaption>" + caption + "</figcaption></figure>\n";
}

std::string floorText(const StudyRecord& record, Model model) {
  const double theta = !traitsOf(model).occlusion ? 0 : record.plan.baseTheta;
  const double floor = referenceError(record, {model, record.plan.baseSize, theta});
  if (floor == 0) return "The reference does not change with its tolerance: it is exact but for rounding.";
  return "The reference itself is off by about " + printShort(floor) + " (RMSE to a coarser one).";
}

std::string modelTitle(Model model) {
  return !traitsOf(model).occlusion ? "Emission: no occlusion" : "Cone: directional occlusion";
}

// Describes the bases of a plan. Methods that share a base are named together.
std::string baseText(const StudyPlan& plan) {
  std::vector<std::pair<std::string, std::string>> bases;  // description, methods
  for (const std::string& name : plan.settings.methods) {
    const StudyCase& base = plan.bases.at(name);
    const StudyMethod::Detail& detail = studyMethod(name).detail;
    std::string text = std::to_string(base.slices) + " slices, " + describeSegments(base.segments);
    if (!detail.name.empty()) text += ", " + detail.symbol + " = " + std::to_string(base.detail);
    const auto known = std::find_if(bases.begin(), bases.end(), [&](const auto& b) { return b.first == text; });
    if (known == bases.end())
      bases.emplace_back(text, name);
    else
      known->second += ", " + name;
  }
  std::string text;
  for (const auto& [base, methods] : bases) text += base + " (" + methods + "); ";
  return text + std::to_string(plan.baseBits.eye) + "-bit eye and " + std::to_string(plan.baseBits.occlusion) +
         "-bit occlusion buffer, " + std::to_string(plan.baseSize) + " pixels high, theta " +
         jsonDegrees(plan.baseTheta) + " degrees";
}

// Describes the front in two numbers: the least error, and what a picture costs that is nearly as good.
std::string modelFacts(const StudyRecord& record, const std::vector<ComparableCases>& groups) {
  std::string html;
  for (const Model model : {Model::cone, Model::emission}) {
    const ComparableCases* group = baseGroup(groups, record.plan, model);
    if (!group || group->front.empty()) continue;
    const CaseResult &best = *group->front.back(), &fastest = *group->front.front();
    html += fact(printShort(best.error.rmse), "least method error of " + modelName(model) + " (RMSE), at " +
                                                  printShort(best.timeRatio.median) +
                                                  " times the baseline: " + describeCase(best.what, record.plan));
    html += fact(printShort(fastest.timeRatio.median) + " x",
                 "fastest " + modelName(model) + ", at a method error of " + printShort(fastest.error.rmse) + ": " +
                     describeCase(fastest.what, record.plan));
  }
  if (const ModelError* error = record.findModelError({Model::cone, record.plan.baseSize, record.plan.baseTheta}))
    html += fact(printShort(error->error.rmse), "model error: the cone of " + jsonDegrees(record.plan.baseTheta) +
                                                    " degrees against the whole sphere (RMSE), whatever the method");
  return html.empty() ? "" : "<div class=\"facts\">\n" + html + "</div>\n";
}

std::string speedSections(const StudyRecord& record, const PageFolder& folder,
                          const std::vector<ComparableCases>& groups) {
  std::string html;
  for (const Model model : {Model::cone, Model::emission}) {
    const ComparableCases* group = baseGroup(groups, record.plan, model);
    if (!group) continue;
    const std::string pareto = plotFigure(folder, paretoPlot(record, model),
                                          "Lines join cases that differ in their slices (N) alone, the same N on each "
                                          "of a method; bars are the quartiles of "
                                          "the time. No case lies below and left of the staircase. " +
                                              floorText(record, model));
    const std::string convergence =
        plotFigure(folder, convergencePlot(record, model),
                   !traitsOf(model).occlusion
                       ? "Order: p of error = c d^p by least squares, over the cases whose error is more than twice "
                         "that of the reference. A shortcut that is worth its time levels off early."
                       : "A method that converges to its model goes on falling. " + floorText(record, model));
    html += section(modelName(model), modelTitle(model),
                    "<h3>Error against time</h3>\n" + pareto + "<h3>Pareto front</h3>\n" + frontTable(record, *group) +
                        earlierTable(record, model) + "<h3>Convergence in the distance of slices</h3>\n" + convergence);
    std::string details;
    for (const StudyMethod& method : studyMethods())
      if (method.model == model && record.plan.settings.details.contains(method.detail.name) &&
          details.find("detail-" + method.detail.name) == std::string::npos)
        details += plotFigure(folder, detailPlot(record, method.detail), "At the base of everything else.");
    if (!details.empty()) html += "<h3>Finer and coarser occlusion</h3>\n" + details;
  }
  return html;
}

std::string pictureSections(const StudyRecord& record, const PageFolder& folder,
                            const std::vector<ComparableCases>& groups) {
  std::string html;
  for (const Model model : {Model::cone, Model::emission})
    if (const ComparableCases* group = baseGroup(groups, record.plan, model))
      html += "<h3>" + modelTitle(model) + "</h3>\n" + casePictures(record, folder, *group);
  return html;
}

std::string machineSection(const StudyRecord& record) {
  const Machine& machine = record.machine;
  double least = 1e9, most = 0;
  for (const CaseResult& result : record.cases) {
    least = std::min(least, result.load);
    most = std::max(most, result.load);
  }
  HtmlTable table;
  const auto row = [&](const std::string& name, const std::string& value) {
    table.rows.push_back({{{escapeHtml(name), "", true}, {escapeHtml(value), "", true}}});
  };
  row("CPU", machine.cpu + ", " + std::to_string(machine.cores) + (machine.cores == 1 ? " core" : " cores"));
  row("OpenGL", machine.renderer);
  if (!record.cases.empty())
    row("Load average while timing", printShort(least) + " to " + printShort(most) + " (1 minute)");
  row("Versions", "umbrick " + machine.version + ", " + machine.compiler + ", " + machine.plotter);
  row("Volume", printable(record.volume.file) + ", " + std::to_string(record.volume.bytes) + " bytes");
  row("Visible extent along the view axis", printShort(record.geometry.extent) + " world units");
  row("Base point", baseText(record.plan));
  const StudySettings& settings = record.plan.settings;
  return printHtml(table) + "<p><b>Time.</b> Case and baseline took turns in one process, at least " +
         std::to_string(settings.repeats) +
         " times each, after a picture of each that did not count. A time is the median of the ratios of neighbours, "
         "so it says how many baseline pictures of the same size a picture costs. The baseline is "
         "<code>emission</code> "
         "with " +
         std::to_string(kBaselineSlices) + " slices, 1 segment and a 32-bit buffer." +
         (machine.software ? " OpenGL ran in software here, so milliseconds would say more of the machine than of the "
                             "method and are left to study.json."
                           : "") +
         "</p>\n<p><b>Error.</b> Of linear premultiplied red, green and blue, without background radiance, against the "
         "reference of the same model, size and theta, which integrates on the CPU with about " +
         std::to_string(settings.directions) + " directions and a tolerance of " + printShort(settings.tolerance) +
         ". <i>Method error</i>: renderer against reference of its own model. <i>Model error</i>: reference of the "
         "cone against the whole sphere. <i>Error of the reference</i>: its difference to one with half of the "
         "directions and four times the tolerance.</p>\n<p><b>Slices.</b> N slices lie d = extent / N apart, where "
         "the extent is that of the visible bricks along the view axis.</p>\n" +
         referenceTable(record);
}

std::string intro(const StudyRecord& record, const std::vector<ComparableCases>& groups) {
  const std::string volume = printable(std::filesystem::path(record.volume.file).filename().string());
  std::string html = "<h1>Speed against error: " + escapeHtml(volume) + "</h1>\n<p class=\"quiet\">" +
                     std::to_string(record.cases.size()) +
                     " pictures, each timed beside a baseline and compared with "
                     "a reference integrated on the CPU. Base point: " +
                     escapeHtml(baseText(record.plan)) + ".</p>\n";
  if (!record.complete())
    html += "<p class=\"warning\">Unfinished: " + std::to_string(record.cases.size()) + " of " +
            std::to_string(record.plan.cases.size()) + " cases. The same command goes on.</p>\n";
  html += modelFacts(record, groups);
  return html;
}

std::string assembled(const StudyRecord& record, const PageFolder& folder) {
  const std::vector<ComparableCases> groups = comparableCases(record);
  struct Part {
    std::string id, title, html;
  };
  const Part parts[]{
      {"when", "Which one when", whichWhenTables(record, groups) + methodPictures(record, folder, groups)},
      {"modes", "Other modes", modeSections(record, folder, groups)},
      {"comparison", "Ordinates beside dos", comparisonTables(record, groups)},
      {"base", "Around the base point", aroundBaseTable(record)},
      {"model", "Model error", modelErrorTable(record) + modelPictures(record, folder)},
      {"pictures", "Pictures", pictureSections(record, folder, groups)},
      {"windows", "What the windows cost", windowTable(record)},
      {"cases", "All cases", caseTable(record, groups)},
      {"machine", "How it was measured", machineSection(record)},
      {"commands", "To repeat it", commandList(record)},
  };
  std::string navigation, body = speedSections(record, folder, groups);
  for (const Model model : {Model::cone, Model::emission})
    if (baseGroup(groups, record.plan, model))
      navigation += "<a href=\"#" + modelName(model) + "\">" + modelTitle(model) + "</a> ";
  for (const Part& part : parts) {
    if (part.html.empty()) continue;
    navigation += "<a href=\"#" + part.id + "\">" + part.title + "</a> ";
    body += section(part.id, part.title, part.html);
  }
  const std::string volume = printable(std::filesystem::path(record.volume.file).filename().string());
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n<meta name=\"viewport\" "
         "content=\"width=device-width, initial-scale=1\"/>\n<title>Speed against error: " +
         escapeHtml(volume) + "</title>\n<style>\n" + std::string(pageText("page.css")) +
         "</style>\n</head>\n<body>\n" + intro(record, groups) + "<nav>" + navigation + "</nav>\n" + body +
         "<script>\n" + std::string(pageText("page.js")) + "</script>\n</body>\n</html>\n";
}

}  // namespace

void writePage(const StudyRecord& record, const PageFolder& folder) {
  folder.create();
  writeTextFile(folder.page(), assembled(record, folder));
}

}  // namespace umbrick::tools
