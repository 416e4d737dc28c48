// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/earlier_study.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "study/invented_study.h"
#include "support/complaint.h"
#include "umbrick/core/error.h"
#include "umbrick/study/study_findings.h"

using namespace umbrick;
using Catch::Contains;
using Json = nlohmann::ordered_json;

TEST_CASE("The fronts of an earlier study are those that it found itself", "[report]") {
  const StudyRecord record = inventedStudy();
  const EarlierStudy earlier = readEarlierStudy(printRecord(record), "old/study.json", record);
  CHECK(earlier.name == "old/study.json");
  std::size_t all = 0;
  for (const ComparableCases& group : comparableCases(record)) all += group.front.size();
  CHECK(earlier.front.size() == all);
  for (const Model model : {Model::cone, Model::emission}) {
    const auto groups = comparableCases(record);
    const ComparableCases* group = baseGroup(groups, record.plan, model);
    REQUIRE(group);
    const std::vector<EarlierCase> cases = earlier.comparable(record, model);
    REQUIRE(cases.size() == group->front.size());
    for (std::size_t i = 0; i < cases.size(); ++i) {
      CHECK(cases[i].id == group->front[i]->what.id());
      CHECK(cases[i].timeRatio == group->front[i]->timeRatio.median);
      CHECK(cases[i].rmse == group->front[i]->error.rmse);
    }
  }
}

TEST_CASE("An earlier study may have other settings, an older format and methods that no longer exist", "[report]") {
  const StudyRecord record = inventedStudy();
  Json old = Json::parse(printRecord(record));
  old["umbrick_study"] = 1;
  old.erase("settings");
  old["scene"]["volume"]["file"] = "/elsewhere.vdb";
  old["scene"]["occlusion"].erase("directions");
  old["scene"]["sampling"]["bits"] = 16;
  old["scene"]["camera"]["size"] = {480, 480};
  old["volume"]["crc32"] = 7;
  old["machine"]["version"] = "0.0.1";
  for (Json& one : old["cases"]) {
    if (one["method"] == "ordinates") one["method"] = "gone";
    one.erase("pass_ms");
    one.erase("windows");
  }
  const EarlierStudy earlier = readEarlierStudy(old.dump(), "old.json", record);
  CHECK(earlier.version == "0.0.1");
  CHECK(std::any_of(earlier.front.begin(), earlier.front.end(),
                    [](const EarlierCase& one) { return one.method == "gone" && one.model == Model::cone; }));
}

TEST_CASE("What cannot be compared is refused with the first thing that differs", "[report]") {
  const StudyRecord record = inventedStudy();
  const auto changed = [&](const std::function<void(Json&)>& change) {
    Json json = Json::parse(printRecord(record));
    change(json);
    return json.dump();
  };
  const auto refusal = [&](const std::function<void(Json&)>& change) {
    return complaint<InvalidArgument>([&] { readEarlierStudy(changed(change), "old.json", record); });
  };
  const std::string start = "old.json: cannot be compared with, it is a study ";
  CHECK(refusal([](Json&) {}) == "no complaint");
  CHECK(refusal([](Json& j) { j["volume"]["bytes"] = 7; }) ==
        start + "of another volume: volume.bytes is 7 there and 12345 here");
  CHECK_THAT(refusal([](Json& j) { j["scene"]["camera"]["fov"] = 7; }),
             Contains(start + "of another scene: camera.fov is 7 there and "));
  CHECK_THAT(refusal([](Json& j) {
               j["scene"]["camera"]["size"] = {7, 14};
             }),
             Contains(start + "of another scene: camera.size is 0.5 there and 1"));
  CHECK_THAT(refusal([](Json& j) { j["extent_world"] = 7; }),
             Contains(start + "with another baseline: extent_world is 7 there and 3.3"));
  CHECK(refusal([](Json& j) { j["machine"]["cores"] = 7; }) ==
        start + "on another machine: machine.cores is 7 there and 2 here");
  const auto fault = [&](const std::string& text) {
    return complaint<IoError>([&] { readEarlierStudy(text, "old.json", record); });
  };
  CHECK(fault("{}") == "old.json: not the record of a study");
  CHECK_THAT(fault("{"), Contains("not JSON"));
  for (const char* field : {"volume", "scene", "machine", "cases", "extent_world"})
    CHECK_THAT(fault(changed([&](Json& j) { j.erase(field); })), Contains(field));
  CHECK_THAT(fault(changed([](Json& j) { j["cases"][0].erase("error"); })), Contains("cases[0]") && Contains("error"));
  CHECK_THAT(fault(changed([](Json& j) { j["volume"]["bytes"] = "7"; })), Contains("volume.bytes"));
  CHECK_THAT(fault(changed([](Json& j) { j["scene"] = 7; })), Contains("scene"));
}
