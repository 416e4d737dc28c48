// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/study_record.h"

#include <catch2/catch.hpp>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "study/invented_study.h"
#include "support/complaint.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Contains;
using Json = nlohmann::ordered_json;

namespace {

// Returns the same study with nothing measured.
StudyRecord unmeasured() {
  StudyRecord record = inventedStudy();
  record.references.clear();
  record.modelErrors.clear();
  record.cases.clear();
  record.geometry.extent = 0;
  return record;
}

std::string refusal(const StudyRecord& stored, const std::function<void(StudyRecord&)>& change) {
  StudyRecord other = unmeasured();
  change(other);
  return complaint<InvalidArgument>([&] { restoreRecord(other, printRecord(stored), "study.json"); });
}

}  // namespace

TEST_CASE("What is written of a study is read back to the last bit", "[report]") {
  StudyRecord stored = inventedStudy();
  stored.cases[1].error.ssim.reset();
  stored.cases[2].error.maxError = std::numeric_limits<double>::infinity();
  StudyRecord restored = unmeasured();
  restoreRecord(restored, printRecord(stored), "study.json");
  CHECK(printRecord(restored) == printRecord(stored));
  CHECK(restored.complete());
  CHECK(restored.references == stored.references);
  REQUIRE(restored.cases.size() == stored.cases.size());
  for (std::size_t i = 0; i < stored.cases.size(); ++i) {
    const CaseResult &a = restored.cases[i], &b = stored.cases[i];
    CHECK(a.what == b.what);
    CHECK(a.error == b.error);
    CHECK(a.timeRatio == b.timeRatio);
    CHECK(a.spacing == b.spacing);
    CHECK(a.slicesDrawn == b.slicesDrawn);
    CHECK(a.windowTexel == b.windowTexel);
    CHECK(a.passes.windowsMs == b.passes.windowsMs);
  }
}

TEST_CASE("The record is JSON that names each case and its numbers", "[report]") {
  const StudyRecord record = inventedStudy();
  const Json json = Json::parse(printRecord(record));
  CHECK(json["complete"] == true);
  REQUIRE(json["cases"].size() == record.cases.size());
  const Json& last = json["cases"].back();
  CHECK(last["method"] == "ordinates");
  CHECK(last["directions"] == 8);
  CHECK(last["windows"]["updates"] == record.cases.back().windowUpdates);
  CHECK(last["theta"] == 80);
  CHECK(last["time_ratio"]["median"] == record.cases.back().timeRatio.median);
  CHECK(last["error"]["rmse"] == record.cases.back().error.rmse);
  CHECK(json["machine"]["cores"] == 2);
}

TEST_CASE("An unfinished study is restored as far as it went", "[report]") {
  StudyRecord stored = inventedStudy();
  stored.cases.resize(4);
  StudyRecord restored = unmeasured();
  restoreRecord(restored, printRecord(stored), "study.json");
  CHECK(!restored.complete());
  CHECK(restored.cases.size() == 4);
  CHECK(restored.find(stored.cases[3].what) != nullptr);
  CHECK(restored.find(restored.plan.cases[4]) == nullptr);
}

TEST_CASE("Another study is refused with the first thing that differs", "[report]") {
  const StudyRecord stored = inventedStudy();
  CHECK(refusal(stored,
                [](StudyRecord& r) {
                  r.plan.settings.slices = {8, 16, 64};
                }) ==
        "study.json: a study with other settings: slices is [8,16,32] there and [8,16,64] here; give another folder");
  CHECK(
      refusal(stored, [](StudyRecord& r) { r.plan.settings.tolerance = 0.5; }) ==
      "study.json: a study with other settings: reference.tolerance is 0.001 there and 0.5 here; give another folder");
  CHECK(refusal(stored, [](StudyRecord& r) { r.scene.camera.eye.x = 3; }) ==
        "study.json: a study of another scene: camera.eye is [0,0,1] there and [3,0,1] here; give another "
        "folder");
  CHECK_THAT(refusal(stored, [](StudyRecord& r) { r.scene.transfer = loadTransferFunction("fire"); }),
             Contains("a study of another scene: transfer"));
  CHECK(refusal(stored, [](StudyRecord& r) { r.volume.crc32 = 7; }) ==
        "study.json: a study of another volume: volume.crc32 is 3735928559 there and 7 here; give another folder");
  // A volume that has moved is the same one.
  CHECK(refusal(stored, [](StudyRecord& r) { r.scene.volume.file = r.volume.file = "/elsewhere.vdb"; }) ==
        "no complaint");
}

TEST_CASE("Times of two machines are not mixed, but a complete study can be shown anywhere", "[report]") {
  StudyRecord stored = inventedStudy();
  const auto faster = [](StudyRecord& r) { r.machine.cpu = "another"; };
  CHECK(refusal(stored, faster) == "no complaint");
  stored.cases.pop_back();
  CHECK_THAT(refusal(stored, faster),
             Contains("unfinished on another machine: machine.cpu is \"a CPU & more\" there and \"another\" here"));
  CHECK(refusal(stored, [](StudyRecord& r) { r.machine.plotter = "newer"; }) == "no complaint");
}

TEST_CASE("A damaged record is reported with its place, and changes nothing", "[report]") {
  const std::string good = printRecord(inventedStudy());
  const auto fault = [&](const std::string& text) {
    StudyRecord record = unmeasured();
    const std::string message = complaint<IoError>([&] { restoreRecord(record, text, "study.json"); });
    CHECK(printRecord(record) == printRecord(unmeasured()));
    return message;
  };
  CHECK_THAT(fault(good.substr(0, good.size() / 2)), Contains("study.json:") && Contains("not JSON"));
  CHECK(fault("{}") == "study.json: not the record of a study");
  CHECK(fault("[1]") == "study.json: not the record of a study");
  const auto changed = [&](const std::function<void(Json&)>& change) {
    Json json = Json::parse(good);
    change(json);
    return fault(json.dump(2));
  };
  CHECK_THAT(changed([](Json& j) { j["umbrick_study"] = 9; }), Contains("umbrick_study: expected 2, found 9"));
  CHECK_THAT(changed([](Json& j) { j.erase("settings"); }), Contains("settings"));
  CHECK_THAT(changed([](Json& j) { j["cases"][0]["id"] = "dos-n9"; }), Contains("cases[0].id") && Contains("'dos-n9'"));
  CHECK_THAT(changed([](Json& j) { j["cases"][0]["pairs"] = "five"; }), Contains("cases[0].pairs"));
  CHECK_THAT(changed([](Json& j) { j["cases"][0].erase("error"); }), Contains("error"));
  CHECK_THAT(changed([](Json& j) { j["scene"] = 3; }), Contains("scene: expected an object"));
  CHECK_THAT(changed([](Json& j) { j["volume"]["bytes"] = "many"; }), Contains("volume.bytes"));
}

TEST_CASE("A volume is known by its bytes", "[report]") {
  const TemporaryFolder folder;
  writeBytes(folder.path() / "check", "123456789");
  const VolumeIdentity identity = identifyVolume(folder.path() / "check");
  CHECK(identity.bytes == 9);
  CHECK(identity.crc32 == 0xcbf43926);  // the check value of CRC-32
  CHECK_THAT(complaint<IoError>([&] { identifyVolume(folder.path() / "none"); }), Contains("none: cannot read"));
  // A folder is its files, one behind the other, and a dataset is its file.
  std::filesystem::create_directory(folder.path() / "series");
  writeBytes(folder.path() / "series" / "b", "6789");
  writeBytes(folder.path() / "series" / "a", "12345");
  CHECK(identifyVolume(folder.path() / "series").crc32 == 0xcbf43926);
  CHECK(identifyVolume(folder.path() / "check:/density").crc32 == 0xcbf43926);
}
