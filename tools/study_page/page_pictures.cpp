// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/json_writer.h"
#include "study_page/commands.h"
#include "study_page/page.h"
#include "study_page/pictures.h"
#include "umbrick/image/colour_map.h"
#include "umbrick/study/case_scene.h"

namespace umbrick::tools {
namespace {

// Returns a bar with the colours of error pictures, from 0 to their scale.
std::string scaleBar(double scale) {
  constexpr int kStops = 16;
  std::string stops;
  for (int i = 0; i <= kStops; ++i) {
    const glm::dvec3 colour = magma(static_cast<double>(i) / kStops) * 255.0;
    char text[40];
    std::snprintf(text, sizeof text, "%s#%02x%02x%02x", i > 0 ? "," : "", static_cast<int>(std::lround(colour.r)),
                  static_cast<int>(std::lround(colour.g)), static_cast<int>(std::lround(colour.b)));
    stops += text;
  }
  return "<div class=\"scale\">error 0 <i style=\"background:linear-gradient(90deg," + stops + ")\"></i> " +
         printShort(scale) + " and above (largest of red, green and blue, relative to L_a)</div>\n";
}

std::string heads(const std::string& first, const std::string& second, const std::string& third) {
  std::string html;
  for (const std::string& name : {first, second, third, std::string()})
    html += "<div class=\"head\">" + escapeHtml(name) + "</div>";
  return html + "\n";
}

std::string row(const PageFolder& folder, const std::string& truth, const std::string& test, const std::string& note) {
  const auto cell = [&](const std::string& id) {
    return "<div>" + embeddedPicture(folder.thumbnail(id), id) + "</div>";
  };
  return cell(truth) + cell(test) + cell(errorPictureId(test)) + "<div class=\"note\">" + note + "</div>\n";
}

std::string errorText(const ErrorMeasures& error) {
  std::string text = "RMSE " + printShort(error.rmse);
  if (error.ssim) text += ", SSIM " + printShort(*error.ssim);
  if (error.flip) text += ", FLIP " + printShort(*error.flip);
  return text;
}

}  // namespace

std::string casePictures(const StudyRecord& record, const PageFolder& folder, const ComparableCases& group) {
  std::string html = scaleBar(errorScale(group.model)) + "<div class=\"pictures\">\n" +
                     heads("reference", "case of the Pareto front", "error");
  for (const CaseResult* result : group.front)
    html += row(folder, record.plan.referenceOf(result->what).id(), result->what.id(),
                "<b>" + escapeHtml(describeCase(result->what, record.plan)) + "</b><br/>" +
                    printShort(result->timeRatio.median) + " times the baseline<br/>" + errorText(result->error));
  return html + "</div>\n";
}

std::string methodPictures(const StudyRecord& record, const PageFolder& folder,
                           const std::vector<ComparableCases>& groups) {
  std::string html;
  for (const Model model : {Model::cone, Model::emission}) {
    const ComparableCases* group = baseGroup(groups, record.plan, model);
    if (!group) continue;
    const std::vector<ErrorReached> all = errorsReached(*group, true);
    const auto reachedBy = [](const ErrorReached& reached) {
      return std::count_if(reached.ways.begin(), reached.ways.end(),
                           [](const ErrorReached::Way& way) { return way.fastest != nullptr; });
    };
    // Errors fall along the list, and fewer methods reach them: the last of those that most reach.
    const ErrorReached* shown = nullptr;
    for (const ErrorReached& reached : all)
      if (!shown || reachedBy(reached) >= reachedBy(*shown)) shown = &reached;
    if (!shown || shown->ways.size() < 2) continue;
    html += "<h3>" + modelName(model) + ": the fastest pictures that are off by at most " + printShort(shown->error) +
            "</h3>\n" + scaleBar(errorScale(model)) + "<div class=\"pictures\">\n" +
            heads("reference", "method", "error");
    for (const ErrorReached::Way& way : shown->ways)
      if (way.fastest)
        html += row(folder, record.plan.referenceOf(way.fastest->what).id(), way.fastest->what.id(),
                    "<b>" + escapeHtml(describeCase(way.fastest->what, record.plan)) + "</b><br/>" +
                        printShort(timeWithLight(*way.fastest)) + " times the baseline<br/>" +
                        errorText(way.fastest->error));
    html += "</div>\n";
  }
  return html;
}

std::string lookPictures(const StudyRecord& record, const PageFolder& folder, const ComparableCases& group) {
  std::string html =
      scaleBar(errorScale(group.model)) + "<div class=\"pictures\">\n" + heads("reference", "finest picture", "error");
  for (const CaseResult* result : finestCases(group))
    html += row(folder, record.plan.referenceOf(result->what).id(), result->what.id(),
                "<b>" + escapeHtml(describeCase(result->what, record.plan)) + "</b><br/>" +
                    printShort(result->timeRatio.median) + " times the baseline<br/>" + errorText(result->error));
  return html + "</div>\n";
}

std::string modelPictures(const StudyRecord& record, const PageFolder& folder) {
  if (record.modelErrors.empty()) return {};
  std::string html =
      scaleBar(errorScale(Model::cone)) + "<div class=\"pictures\">\n" + heads("whole sphere", "cone", "model error");
  for (const ModelError& error : record.modelErrors)
    html += row(folder, StudyReference{Model::ambient, error.cone.size, 0, StudyLook::medium}.id(), error.cone.id(),
                "<b>theta " + jsonDegrees(error.cone.theta) + " degrees</b><br/>" + errorText(error.error));
  return html + "</div>\n";
}

std::string commandList(const StudyRecord& record) {
  std::string html =
      "<p>In the folder of this report; <code>scene.json</code> is the scene of all of them, and the pictures of "
      "<code>references/</code> are there already. <code>plots/NAME.gp</code> draws a plot again: "
      "<code>gnuplot NAME.gp</code>.</p>\n<details><summary>References</summary>\n";
  for (const StudyReference& what : record.plan.references)
    html += "<pre>" + escapeHtml(referenceCommand(what, record.scene, record.plan.settings)) + "</pre>\n";
  html += "</details>\n";
  for (const StudyCase& what : record.plan.cases)
    html += "<details id=\"c-" + what.id() + "\"><summary>" + escapeHtml(describeCase(what, record.plan)) +
            "</summary>\n<pre>" + escapeHtml(renderCommand(what, record.scene, record.geometry)) + "\n" +
            escapeHtml(compareCommand(what, record.plan.referenceOf(what))) + "</pre></details>\n";
  return html;
}

}  // namespace umbrick::tools
