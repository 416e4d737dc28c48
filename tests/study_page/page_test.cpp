// SPDX-License-Identifier: Apache-2.0
#include "study_page/page.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "study/invented_study.h"
#include "study_page/pictures.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "support/xml.h"

using namespace umbrick;
using namespace umbrick::tools;
using Catch::Contains;

namespace {

std::string pageOf(const StudyRecord& record, const TemporaryFolder& parent) {
  const PageFolder folder(parent.path() / "report");
  Image grey(16, 16);
  std::fill(grey.pixels.begin(), grey.pixels.end(), 0.5f);
  if (!record.cases.empty())
    writePictures(folder, {record.cases.front().what.id(), Model::emission, grey}, glm::dvec3(1));
  writePage(record, folder);
  return readBytes(folder.page());
}

}  // namespace

TEST_CASE("The check of well-formedness finds what is not", "[study_page]") {
  CHECK(xmlFault("<!DOCTYPE html>\n<a b='<'></a>") != "");
  CHECK(xmlFault("<a><b></a></b>") != "");
  CHECK(xmlFault("<a>") != "");
  CHECK(xmlFault("<a>1 < 2</a>") != "");
  CHECK(xmlFault("<a><b id=\"x\"/><c id=\"x\"/></a>") != "");
  CHECK(xmlFault("<a title='x > y'>1 &lt; 2<br/><script>if (a < b) c();</script></a>").empty());
}

TEST_CASE("The page is well-formed, whatever names there are", "[study_page]") {
  const TemporaryFolder folder;
  const std::string page = pageOf(inventedStudy(), folder);
  CHECK(xmlFault(page) == "");
  CHECK_THAT(page, Contains("a &lt;b&gt; &amp; &quot;c&quot;.vdb") && !Contains("a <b>"));
  // One plot per model for time and for convergence, one for the footprint and one for the directions.
  std::size_t plots = 0;
  for (std::size_t at = 0; (at = page.find("<svg", at)) != std::string::npos; ++at) ++plots;
  CHECK(plots == 6);
  CHECK_THAT(page, Contains("order 1.00"));  // inventedStudy's error is proportional to d
  CHECK_THAT(page, Contains("data:image/png;base64,iVBORw0KGgo"));
  CHECK_THAT(page, Contains("missing"));  // the pictures that are not there
  CHECK_THAT(page, !Contains("Unfinished"));
  CHECK_THAT(page, Contains("id=\"comparison\"") && Contains("id=\"windows\"") && Contains("id=\"when\""));
}

TEST_CASE("The page shows an earlier study in the plots of time and in tables, and says where it has nothing",
          "[study_page]") {
  const TemporaryFolder folder;
  StudyRecord record = inventedStudy();
  record.earlier = readEarlierStudy(printRecord(record), "old & <grey>.json", record);
  std::erase_if(record.earlier->front, [](const EarlierCase& one) { return one.model == Model::emission; });
  const std::string page = pageOf(record, folder);
  CHECK(xmlFault(page) == "");
  CHECK_THAT(page, Contains("The Pareto front of <code>old &amp; &lt;grey&gt;.json</code>") &&
                       Contains("earlier Pareto front") &&
                       Contains("old &amp; &lt;grey&gt;.json</code> (umbrick 0.0) has no case"));
}

TEST_CASE("The page loads nothing from elsewhere", "[study_page]") {
  const TemporaryFolder folder;
  const std::string page = pageOf(inventedStudy(), folder);
  for (const std::string attribute : {"src", "href"})
    for (const char quote : {'"', '\''}) {
      const std::string begin = attribute + "=" + quote;
      for (std::size_t at = 0; (at = page.find(begin, at)) != std::string::npos;) {
        at += begin.size();
        const std::string target = page.substr(at, page.find(quote, at) - at);
        const bool citation = target.starts_with("https://doi.org/");
        const bool inside = target.starts_with("data:image/png;base64,") || target.starts_with("#");
        CAPTURE(target.substr(0, 80));
        CHECK((inside || (citation && page.compare(at - 9, 3, "<a ") == 0)));
      }
    }
  CHECK_THAT(page, !Contains("@import") && !Contains("url(http") && !Contains("<link"));
}

TEST_CASE("Every anchor of the page leads somewhere", "[study_page]") {
  const TemporaryFolder folder;
  const std::string page = pageOf(inventedStudy(), folder);
  int anchors = 0;
  for (std::size_t at = 0; (at = page.find("href=\"#", at)) != std::string::npos; ++anchors) {
    at += 7;
    const std::string target = page.substr(at, page.find('"', at) - at);
    CAPTURE(target);
    CHECK(page.find("id=\"" + target + "\"") != std::string::npos);
  }
  CHECK(anchors > 20);
}

TEST_CASE("A page of a study that has not begun, or is not done, says so", "[study_page]") {
  const TemporaryFolder folder;
  StudyRecord record = inventedStudy();
  const std::size_t all = record.cases.size();
  record.cases.resize(3);
  const std::string begun = pageOf(record, folder);
  CHECK(xmlFault(begun) == "");
  CHECK_THAT(begun, Contains("Unfinished: 3 of " + std::to_string(all) + " cases"));
  record.cases.clear();
  record.references.clear();
  record.modelErrors.clear();
  CHECK(xmlFault(pageOf(record, folder)) == "");
}

TEST_CASE("Base64 is that of RFC 4648", "[study_page]") {
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64(std::string("\xff\x00\xfe", 3)) == "/wD+");
}

TEST_CASE("A picture is written with its error, and a small copy of a tall one", "[study_page]") {
  const TemporaryFolder parent;
  const PageFolder folder(parent.path());
  const Image low(8, 8), tall(8, kThumbnailHeight + 1);
  writePictures(folder, {"reference", Model::cone, low}, glm::dvec3(1));
  CHECK(std::filesystem::exists(folder.picture("reference")));
  CHECK(!std::filesystem::exists(folder.picture("reference.error")));
  CHECK(folder.thumbnail("reference") == folder.picture("reference"));
  writePictures(folder, {"case", Model::cone, tall, &tall}, glm::dvec3(1));
  CHECK(std::filesystem::exists(folder.picture("case")));
  for (const char* id : {"case", "case.error"}) CHECK(folder.thumbnail(id) == folder.smallPicture(id));
}

TEST_CASE("A thumbnail keeps the mean of a picture that it divides", "[study_page]") {
  Image image(12, 8);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i % 7);
  const Image small = shrunk(image, 4);
  CHECK(small.width == 6);
  CHECK(small.height == 4);
  double a = 0, b = 0;
  for (const float p : image.pixels) a += p;
  for (const float p : small.pixels) b += 4 * p;
  CHECK(b == Approx(a).epsilon(1e-6));  // single precision
  CHECK(shrunk(image, 8).pixels == image.pixels);
}

TEST_CASE("The page says which method is the fastest for an error", "[study_page]") {
  StudyRecord record = inventedStudy();
  std::vector<ComparableCases> groups = comparableCases(record);
  CHECK_THAT(whichWhenTables(record, groups),
             Contains("cone</h3>") && Contains("<b>ordinates</b>, 3.6 times as fast as dos, Algorithm 3") &&
                 !Contains("light kept") && !Contains("emission</h3>"));  // of one method there is no choice
  for (CaseResult& result : record.cases)
    if (result.what.method == "ordinates") result.lightMs = 100 * result.baselineMs;
  const std::string lit = whichWhenTables(record, groups);
  CHECK_THAT(lit, Contains("cone, light computed for the picture") && Contains("cone, light kept from the picture"));
  CHECK_THAT(lit, Contains("<b>dos, Algorithm 3</b>") && Contains("<b>ordinates</b>"));
}

TEST_CASE("The page sets techniques beside each other in each mode", "[study_page]") {
  StudySettings settings;
  settings.methods = {"emission", "mip-rays", "mip-rays-gl", "phong-rays", "phong-shear-warp"};
  settings.slices = {8, 16};
  settings.sizes = {16};
  settings.bits = {{32, 32}};
  settings.segments = {1};
  StudyRecord record = inventedStudy();
  record.plan = planStudy(settings, 60 * kDegree);
  record.scene = studyScene(smokeScene(), record.plan, 1);
  const CaseResult any = record.cases.front();
  record.cases.clear();
  record.references.clear();
  record.modelErrors.clear();
  for (const StudyReference& what : record.plan.references) record.references.push_back({what, 10, 2, any.error});
  for (const StudyCase& what : record.plan.cases) {
    record.cases.push_back(any);
    record.cases.back().what = what;
    record.cases.back().error.rmse = what.slices == 16 ? 0.01 : 0.02;
    record.cases.back().timeRatio.median = what.method == "mip-rays" ? 0.25 * what.slices : what.slices;
  }
  const TemporaryFolder folder;
  const std::string page = pageOf(record, folder);
  CHECK(xmlFault(page) == "");
  CHECK_THAT(page, Contains("id=\"modes\"") && Contains("<h3>mip: the largest value") && Contains("<h3>Phong: ") &&
                       !Contains("<h3>hybrid") && Contains("maximum by rays on the CPU") &&
                       Contains("Phong by shear-warp on the CPU"));
  const std::vector<ComparableCases> groups = comparableCases(record);
  CHECK_THAT(modeSections(record, PageFolder(folder.path() / "report"), groups), Contains("<b>2</b>"));
  // What shows something else is no part of the comparison of media.
  CHECK(whichWhenTables(record, groups).empty());
  const StudyRecord back = [&] {
    StudyRecord restored{.plan = record.plan, .scene = record.scene};
    restored.volume = record.volume;
    restored.machine = record.machine;
    restoreRecord(restored, printRecord(record), "study.json");
    return restored;
  }();
  CHECK(back.references.size() == record.references.size());
  CHECK(back.complete());
}
