// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/study.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "support/complaint.h"
#include "support/files.h"
#include "support/gl_fixture.h"
#include "support/temporary_folder.h"
#include "support/test_grids.h"
#include "support/test_scenes.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/image/exr.h"
#include "umbrick/scene/resolve.h"

using namespace umbrick;
namespace fs = std::filesystem;
using Catch::Contains;
using Json = nlohmann::ordered_json;

namespace {

// A ball that gets denser inwards, in a file of its own.
struct SmallStudy {
  TemporaryFolder folder;
  ScalarGrid grid;
  Scene scene;
  StudySettings settings;

  SmallStudy() {
    const fs::path file = folder.path() / "ball.vdb";
    openvdb::io::File out(file.string());
    grid = makeFilled(glm::ivec3(12), glm::ivec3(0),
                      [](const glm::ivec3& p) { return std::max(0.0, 1 - glm::length(glm::dvec3(p) - 5.5) / 6); });
    out.write({std::const_pointer_cast<openvdb::FloatGrid>(grid.grid)});
    out.close();
    scene.volume.file = file;
    scene.transfer = TransferFunction({{0.1, {{0.9, 0.7, 0.5}, 0}}, {1, {{0.9, 0.7, 0.5}, 2}}});
    scene.camera.width = scene.camera.height = 16;
    scene.background = glm::dvec3(0.5);
    settings.methods = {"emission", "dos"};
    settings.slices = {8, 16};
    settings.details["footprint"] = {2};
    settings.bits = {{32, 32}};
    settings.segments = {1, 2};
    settings.sizes = {16};
    settings.thetas = {60 * kDegree};
    settings.repeats = 1;
    settings.directions = 8;
    settings.tolerance = 0.05;
  }
  ResolvedScene resolved() const { return resolveScene(scene, grid.worldBounds(), grid.indexToWorld()); }
  fs::path report() const { return folder.path() / "report"; }
  Json record() const { return Json::parse(readBytes(report() / "study.json")); }
};

std::map<std::string, std::string> contentsOf(const fs::path& folder) {
  std::map<std::string, std::string> contents;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    contents[entry.path().string()] = entry.is_regular_file() ? readBytes(entry.path()) : "folder";
  return contents;
}

}  // namespace

TEST_CASE("A stopped study goes on where it was, and measures nothing twice", "[report]") {
  const auto context = testContext();
  if (!context) return;
  const SmallStudy study;
  std::vector<std::string> steps;
  std::size_t stopAfter = 0;
  const auto progress = [&](const StudyProgress& p) {
    CHECK(p.share >= 0);
    CHECK(p.share <= 1);
    steps.push_back(p.step);
    return p.casesDone < stopAfter;
  };
  const auto run = [&] {
    return runStudy(*context, study.grid, study.resolved(), study.settings, study.report(), {.progress = progress});
  };
  // The first run stops in the first reference.
  CHECK(!run().study.complete());
  CHECK(study.record()["cases"].empty());
  CHECK(study.record()["references"].empty());
  // The second run stops after two cases.
  stopAfter = 2;
  const StudyOutcome stopped = run();
  CHECK(!stopped.study.complete());
  CHECK(stopped.study.cases.size() == 2);
  const Json first = study.record();
  REQUIRE(first["cases"].size() == 2);
  CHECK(first["complete"] == false);
  // The third run goes to the end.
  stopAfter = 1000;
  steps.clear();
  const StudyOutcome finished = run();
  CHECK(finished.study.complete());
  const Json second = study.record();
  CHECK(second["complete"] == true);
  REQUIRE(second["cases"].size() == finished.study.plan.cases.size());
  // What was measured before is unchanged, times included.
  for (std::size_t i = 0; i < 2; ++i) CHECK(second["cases"][i] == first["cases"][i]);
  CHECK(second["references"] == first["references"]);
  for (const std::string& step : steps) {
    CHECK_THAT(step, !Contains("reference"));
    for (const Json& done : first["cases"]) CHECK(step != done["id"]);
  }
  // The cases are the same as in a study without a stop.
  SmallStudy whole;
  whole.scene.volume.file = study.scene.volume.file;
  runStudy(*context, whole.grid, whole.resolved(), whole.settings, whole.report());
  const Json once = whole.record();
  REQUIRE(once["cases"].size() == second["cases"].size());
  for (std::size_t i = 0; i < once["cases"].size(); ++i) {
    CHECK(once["cases"][i]["id"] == second["cases"][i]["id"]);
    CHECK(once["cases"][i]["error"] == second["cases"][i]["error"]);
  }
}

TEST_CASE("A reference that was made otherwise is refused and left as it is", "[report]") {
  const auto context = testContext();
  if (!context) return;
  const SmallStudy study;
  const auto run = [&](std::size_t stopAfter) {
    return runStudy(*context, study.grid, study.resolved(), study.settings, study.report(),
                    {.progress = [&](const StudyProgress& p) { return p.casesDone < stopAfter; }});
  };
  run(1);
  REQUIRE(study.record()["cases"].size() == 1);
  const fs::path file = study.report() / "references" / "cone-s16-t60.exr";
  const ExrFile stored = readExr(file);
  ExrOptions options;
  options.pixel = ExrPixel::float32;
  options.metadata = stored.metadata;
  // Earlier versions had the command that makes the picture here.
  options.metadata["umbrick.study.reference"] = "umbrick reference scene.json --model cone";
  writeExr(file, {{"", stored.layers.front().image}}, options);
  const std::string before = readBytes(file);
  CHECK_THAT(complaint<InvalidArgument>([&] { run(1000); }),
             Contains("cone-s16-t60.exr: not the reference that this version makes for this study"));
  CHECK(readBytes(file) == before);
}

TEST_CASE("A complete study is not measured again", "[report]") {
  const auto context = testContext();
  if (!context) return;
  const SmallStudy study;
  const StudyOutcome outcome = runStudy(*context, study.grid, study.resolved(), study.settings, study.report());
  REQUIRE(outcome.study.complete());
  CHECK(readBytes(outcome.record) == printRecord(outcome.study));
  const auto before = contentsOf(study.report());
  fs::remove(outcome.table);
  int pictures = 0;
  runStudy(*context, study.grid, study.resolved(), study.settings, study.report(),
           {.picture = [&](const StudyPicture&) { ++pictures; }});
  CHECK(pictures == 0);
  CHECK(contentsOf(study.report()) == before);
}

TEST_CASE("Every picture is handed on with what its error is measured against", "[report]") {
  const auto context = testContext();
  if (!context) return;
  const SmallStudy study;
  std::map<std::string, double> rmse;  // of pictures that have a truth
  std::set<std::string> alone;
  const auto picture = [&](const StudyPicture& p) {
    if (p.truth)
      rmse[p.id] = measureError(p.image, *p.truth).rmse;
    else
      alone.insert(p.id);
  };
  const StudyRecord record =
      runStudy(*context, study.grid, study.resolved(), study.settings, study.report(), {.picture = picture}).study;
  std::set<std::string> references;
  for (const StudyReference& what : record.plan.references) references.insert(what.id());
  CHECK(alone == references);
  CHECK(rmse.size() == record.cases.size() + record.modelErrors.size());
  for (const CaseResult& result : record.cases) CHECK(rmse.at(result.what.id()) == result.error.rmse);
  for (const ModelError& error : record.modelErrors) CHECK(rmse.at(error.cone.id()) == error.error.rmse);
}

TEST_CASE("Errors fall with the number of slices, and the model's error is told apart from the method's", "[report]") {
  const auto context = testContext();
  if (!context) return;
  SmallStudy study;
  study.settings.directions = 24;  // so many that half of them make nearly the same reference
  study.settings.slices = {4, 64};
  runStudy(*context, study.grid, study.resolved(), study.settings, study.report());
  const Json record = study.record();
  std::map<std::string, double> rmse;
  for (const Json& one : record["cases"]) rmse[one["id"]] = one["error"]["rmse"];
  CHECK(rmse.at("emission-N64-k1-e32-s16") < 0.25 * rmse.at("emission-N4-k1-e32-s16"));
  CHECK(rmse.at("emission-N64-k1-e32-s16") > 0);
  REQUIRE(record["model_errors"].size() == 1);
  // Light from the side and from behind is missing, which is far more than the reference's own error.
  CHECK(record["model_errors"][0]["error"]["rmse"] > 0.01);
  for (const Json& reference : record["references"]) {
    CHECK(reference["time_ratio"] > 0);
    CHECK(reference["difference_to_coarser"]["rmse"] < 0.01);
  }
}

TEST_CASE("The scene's model, method and background do not matter to a study", "[report]") {
  const auto context = testContext();
  if (!context) return;
  SmallStudy study;
  study.settings.slices = {8};
  runStudy(*context, study.grid, study.resolved(), study.settings, study.report());
  study.scene.model = Model::ambient;
  study.scene.background.reset();
  study.scene.sampling.spacing = 3;
  study.scene.occlusion.dos.footprint = 7;
  CHECK(runStudy(*context, study.grid, study.resolved(), study.settings, study.report()).study.complete());
}

TEST_CASE("What a study cannot use is refused before anything is written", "[report]") {
  const auto context = testContext();
  if (!context) return;
  SmallStudy study;
  const auto refusal = [&] {
    const auto before = contentsOf(study.folder.path());
    const std::string message = complaint<InvalidArgument>(
        [&] { runStudy(*context, study.grid, study.resolved(), study.settings, study.report()); });
    CHECK(contentsOf(study.folder.path()) == before);
    return message;
  };
  study.settings.methods = {"dos", "magic"};
  CHECK_THAT(refusal(), Contains("methods: no method 'magic'"));
  study.settings.methods = {"emission"};
  study.settings.details.clear();
  study.scene.camera.width = study.scene.camera.height = 16;

  writeBytes(study.report(), "a file");
  CHECK_THAT(refusal(), Contains("report: expected a folder, found a file"));
  fs::remove(study.report());
  fs::create_directory(study.report());
  writeBytes(study.report() / "notes.txt", "mine");
  CHECK_THAT(refusal(), Contains("report: holds files but no study.json"));
  writeBytes(study.report() / "study.json", "{\"umbrick_study\": 2}");
  const auto before = contentsOf(study.report());
  CHECK_THAT(
      complaint<IoError>([&] { runStudy(*context, study.grid, study.resolved(), study.settings, study.report()); }),
      Contains("study.json:1:1: ") && Contains("settings"));
  CHECK(contentsOf(study.report()) == before);
  fs::remove_all(study.report());

  runStudy(*context, study.grid, study.resolved(), study.settings, study.report());
  study.settings.slices = {8, 32};
  CHECK_THAT(refusal(), Contains("a study with other settings: slices is [8,16] there and [8,32] here"));
  study.settings.slices = {8, 16};
  study.scene.orbit = Orbit{1, 0};
  CHECK_THAT(refusal(), Contains("a study of another scene: camera.eye"));
  fs::remove_all(study.report());

  study.scene.transfer = TransferFunction({{5, {{1, 1, 1}, 0}}, {6, {{1, 1, 1}, 1}}});
  CHECK_THAT(refusal(), Contains("nothing to study"));
  study.scene.transfer = TransferFunction({{0.1, {{1, 1, 1}, 0}}, {1, {{1, 1, 1}, 1}}});
  study.settings.sizes = {60000};
  CHECK_THAT(refusal(), Contains("sizes: 60000 x 60000 pixels are beyond the driver's limit of "));
}

TEST_CASE("A study of other modes compares each with the reference of its own", "[report]") {
  const auto context = testContext();
  if (!context) return;
  SmallStudy study;
  study.scene.surfaces = {SceneSurface{.value = 0.5}};
  study.settings.methods = {"emission"};
  study.settings.details.clear();
  for (const StudyMethod& method : studyMethods())
    if (method.look != StudyLook::medium) study.settings.methods.push_back(method.name);
  study.settings.slices = {32};
  study.settings.segments = {1};
  const StudyRecord record = runStudy(*context, study.grid, study.resolved(), study.settings, study.report()).study;
  REQUIRE(record.complete());
  CHECK(record.references.size() == std::size(kLooks));
  for (const CaseResult& result : record.cases) {
    CAPTURE(result.what.id());
    // 32 slices through a ball of 12 voxels; a picture of another mode is off by far more.
    CHECK(result.error.rmse < 5e-3);
    CHECK(result.timeRatio.median > 0);
    CHECK(result.textureBytes > 0);
    CHECK(result.lightMs == 0);
  }
}
