// The section of a page that sets techniques beside each other in modes other than that of a medium alone.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <vector>

#include "core/json_writer.h"
#include "study_page/page.h"

namespace umbrick::tools {
namespace {

std::string titleOf(StudyLook look) {
  switch (look) {
    case StudyLook::medium:
      break;
    case StudyLook::phong:
      return "Phong: a medium that reflects light";
    case StudyLook::mip:
      return "mip: the largest value along each ray";
    case StudyLook::minip:
      return "minip: the smallest value along each ray";
    case StudyLook::average:
      return "average: the mean of the values along each ray";
    case StudyLook::xray:
      return "xray: the share of light that gets through";
    case StudyLook::isosurface:
      return "isosurface: the surfaces of the scene";
    case StudyLook::hybrid:
      return "hybrid: the first surface, and the medium behind it";
  }
  return "medium";
}

double mebibytes(const CaseResult& result) {
  return static_cast<double>(result.bufferBytes + result.textureBytes) / (1 << 20);
}

std::string lookTable(const StudyRecord& record, const ComparableCases& group) {
  HtmlTable table;
  table.head = {{"technique", "", true}, {"time"}, {"RMSE"}, {"max"}, {"SSIM"}, {"MiB"}};
  const CaseResult* fastest = *std::min_element(
      group.all.begin(), group.all.end(),
      [](const CaseResult* a, const CaseResult* b) { return a->timeRatio.median < b->timeRatio.median; });
  for (const CaseResult* result : group.all) {
    const std::string time = printShort(result->timeRatio.median);
    table.rows.push_back(
        {{{"<a href=\"#c-" + result->what.id() + "\">" + escapeHtml(describeCase(result->what, record.plan)) + "</a>",
           "", true},
          {result == fastest ? "<b>" + time + "</b>" : time},
          {printShort(result->error.rmse)},
          {printShort(result->error.maxError)},
          {result->error.ssim ? printShort(*result->error.ssim) : "-"},
          {printShort(mebibytes(*result))}}});
  }
  return printHtml(table);
}

}  // namespace

std::string modeSections(const StudyRecord& record, const PageFolder& folder,
                         const std::vector<ComparableCases>& groups) {
  std::string html;
  for (const auto& [name, look] : kLooks) {
    if (look == StudyLook::medium) continue;
    const ComparableCases* group = baseGroup(groups, record.plan, Model::emission, look);
    if (!group) continue;
    html += "<h3>" + escapeHtml(titleOf(look)) + "</h3>\n" + lookTable(record, *group) +
            lookPictures(record, folder, *group);
  }
  if (html.empty()) return {};
  return "<p>The same scene in each other mode, by the techniques that have it, without occlusion and against the "
         "reference of that mode. Times are multiples of the same baseline, a picture of the medium by slices; the "
         "fastest is bold. MiB are those of bricks and buffers. Isosurfaces are found in each cell of voxels, whatever "
         "the number of slices.</p>\n" +
         html;
}

}  // namespace umbrick::tools
