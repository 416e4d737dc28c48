// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/study_plan.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <set>
#include <string>

#include "study/invented_study.h"
#include "support/complaint.h"
#include "support/test_scenes.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/study/case_scene.h"

using namespace umbrick;

namespace {

StudySettings small() {
  StudySettings settings;
  settings.methods = {"dos", "emission"};
  settings.slices = {16, 4, 8};
  settings.details["footprint"] = {5, 2, 3};
  settings.bits = {{16, 16}, {32, 32}};
  settings.segments = {2, 1};
  settings.sizes = {32, 16};
  settings.thetas = {80 * kDegree, 60 * kDegree};
  return settings;
}

std::set<std::string> idsOf(const StudyPlan& plan) {
  std::set<std::string> ids;
  for (const StudyCase& one : plan.cases) ids.insert(one.id());
  return ids;
}

}  // namespace

TEST_CASE(
    "A plan is a product of slices and detail and of slices and theta, and one sweep per other axis, around the base",
    "[report]") {
  const StudyPlan plan = planStudy(small(), 60 * kDegree);
  std::set<std::string> expected;
  for (const char* n : {"2", "3", "5"})
    for (const char* slices : {"4", "8", "16"})
      expected.insert(std::string("dos-n") + n + "-N" + slices + "-k1-e32o32-s32-t60");
  for (const char* other : {"k2-e32o32-s32-t60", "k1-e16o16-s32-t60", "k1-e32o32-s16-t60"})
    expected.insert(std::string("dos-n3-N8-") + other);
  for (const char* slices : {"4", "8", "16"}) expected.insert(std::string("dos-n3-N") + slices + "-k1-e32o32-s32-t80");
  for (const char* slices : {"4", "8", "16"}) expected.insert(std::string("emission-N") + slices + "-k1-e32-s32");
  for (const char* other : {"k2-e32-s32", "k1-e16-s32", "k1-e32-s16"})
    expected.insert(std::string("emission-N8-") + other);
  CHECK(idsOf(plan) == expected);
  CHECK(plan.cases.size() == expected.size());
}

TEST_CASE("Slabs of ordinates have automatic segments at the base, and its windows' scale is swept", "[report]") {
  StudySettings settings = small();
  settings.methods = {"ordinates"};
  settings.details = {{"directions", {4, 16}}};
  settings.scales = {2, 0.5};
  std::set<std::string> expected;
  for (const char* k : {"4", "16"})
    for (const char* slices : {"4", "8", "16"})
      expected.insert(std::string("ordinates-K") + k + "-N" + slices + "-ka-e32o32-s32-t60");
  for (const char* other : {"k1-e32o32-s32-t60", "k2-e32o32-s32-t60", "ka-e16o16-s32-t60", "ka-e32o32-s16-t60",
                            "ka-e32o32-s32-t60-w0.5", "ka-e32o32-s32-t60-w2"})
    expected.insert(std::string("ordinates-K16-N8-") + other);
  for (const char* slices : {"4", "8", "16"})
    expected.insert(std::string("ordinates-K16-N") + slices + "-ka-e32o32-s32-t80");
  CHECK(idsOf(planStudy(settings, 60 * kDegree)) == expected);
  settings.scales = std::vector<double>();
  for (const StudyCase& one : planStudy(settings, 60 * kDegree).cases) CHECK(one.scale == 0);
}

TEST_CASE("Every method has slices of its own, except numbers too small to draw", "[report]") {
  StudySettings settings = small();
  settings.slices.clear();
  settings.methods = {"dos", "ordinates"};
  const StudyPlan all = planStudy(settings, 1), fewer = planStudy(settings, 1, 100);
  for (const std::string& name : settings.methods) {
    const std::vector<int>& own = studyMethod(name).slices;
    CHECK(all.slices.at(name) == own);
    CHECK(std::find(own.begin(), own.end(), all.bases.at(name).slices) != own.end());
    std::vector<int> left = own;
    std::erase_if(left, [](int slices) { return slices < 100; });
    CHECK(left.size() < own.size());
    CHECK(fewer.slices.at(name) == left);
  }
  CHECK(all.slices.at("ordinates").front() < all.slices.at("dos").front());
  // The slices that the user gives are not changed: they are refused when they cannot be drawn.
  settings.slices = {8, 16};
  CHECK(planStudy(settings, 1, 100).slices.at("dos") == settings.slices);
  settings.slices.clear();
  CHECK(complaint<InvalidArgument>([&] { planStudy(settings, 1, 2000); }) ==
        "slices: fewer than 2000 cannot be drawn, and dos has no more to sweep; give others");
}

TEST_CASE("A plan has the references that its cases need, and the whole sphere at the base size", "[report]") {
  const StudyPlan plan = planStudy(small(), 60 * kDegree);
  std::set<std::string> ids;
  for (const StudyReference& reference : plan.references) ids.insert(reference.id());
  CHECK(ids == std::set<std::string>{"emission-s32", "emission-s16", "cone-s32-t60", "cone-s16-t60", "cone-s32-t80",
                                     "ambient-s32"});
  CHECK(plan.references.size() == ids.size());
  for (const StudyCase& one : plan.cases) CHECK(ids.contains(plan.referenceOf(one).id()));
}

TEST_CASE("A study without occlusion needs no sphere", "[report]") {
  StudySettings settings = small();
  settings.methods = {"emission"};
  settings.details.clear();
  for (const StudyReference& reference : planStudy(settings, 1).references) CHECK(reference.model == Model::emission);
}

TEST_CASE("The order of the values does not matter", "[report]") {
  StudySettings turned = small();
  std::reverse(turned.methods.begin(), turned.methods.end());
  for (auto* list : {&turned.slices, &turned.details["footprint"], &turned.segments, &turned.sizes})
    std::sort(list->begin(), list->end());
  std::reverse(turned.bits.begin(), turned.bits.end());
  std::reverse(turned.thetas.begin(), turned.thetas.end());
  const StudyPlan a = planStudy(small(), 60 * kDegree), b = planStudy(turned, 60 * kDegree);
  CHECK(a.cases == b.cases);
  CHECK(a.references == b.references);
  CHECK(a.settings == b.settings);
}

TEST_CASE("The base is the scene's theta when it is swept, however its degrees were read", "[report]") {
  CHECK(planStudy(small(), std::nextafter(80 * kDegree, 0.0)).baseTheta == 80 * kDegree);
  CHECK(planStudy(small(), 1.0).baseTheta == 60 * kDegree);
  StudySettings own = small();
  own.thetas.clear();
  CHECK(planStudy(own, 1.0).settings.thetas == std::vector<double>{1.0, 80 * kDegree});
  CHECK(planStudy(own, 1.0).baseTheta == 1.0);
  CHECK(planStudy(own, 80 * kDegree).settings.thetas.size() == 1);
}

TEST_CASE("Every method of the registry can be planned, and makes a valid scene of its model", "[report]") {
  for (const StudyMethod& method : studyMethods()) {
    CAPTURE(method.name);
    StudySettings settings = small();
    settings.methods = {method.name};
    settings.details.clear();
    const StudyPlan plan = planStudy(settings, 1);
    REQUIRE(!plan.cases.empty());
    const ResolvedScene scene = smokeScene();
    for (const StudyCase& one : plan.cases) {
      const ResolvedScene made = caseScene(scene, one, {10.0, 1.0});
      CHECK_NOTHROW(validateScene(made));
      CHECK(made.model == method.model);
      CHECK(made.sampling.spacing == 10.0 / one.slices);
      CHECK(made.camera.height == one.size);
    }
  }
}

TEST_CASE("The quick study is a plan of at most 30 pictures", "[report]") {
  const StudyPlan plan = planStudy(quickStudySettings(), 60 * kDegree);
  CHECK(plan.cases.size() <= 30);
  CHECK(plan.settings.methods.size() >= 2);
}

TEST_CASE("A plan refuses what cannot be swept", "[report]") {
  const auto refusal = [](const std::function<void(StudySettings&)>& change) {
    StudySettings settings = small();
    change(settings);
    return complaint<InvalidArgument>([&] { planStudy(settings, 1); });
  };
  using Settings = StudySettings;
  CHECK(refusal([](Settings& s) { s.methods = {"raytracing"}; }).find("methods: no method 'raytracing': there are ") ==
        0);
  CHECK(refusal([](Settings& s) { s.methods = {"dos", "dos"}; }) == "methods: dos is given twice");
  CHECK(refusal([](Settings& s) { s.segments = {}; }) == "segments: nothing to sweep, expected at least one");
  CHECK(refusal([](Settings& s) { s.slices = {0}; }) == "slices: is 0, must be in [1, 100000]");
  CHECK(refusal([](Settings& s) { s.slices = {8, 16, 8}; }) == "slices: 8 is given twice");
  CHECK(refusal([](Settings& s) { s.details["footprint"] = {17}; }) == "footprints: is 17, must be in [1, 16]");
  CHECK(refusal([](Settings& s) { s.bits = {{8, 32}}; }) == "bits: is 8, must be 16 or 32");
  CHECK(refusal([](Settings& s) { s.segments = {9}; }) == "segments: is 9, must be in [1, 8]");
  CHECK(refusal([](Settings& s) { s.sizes = {0}; }) == "sizes: is 0, must be in [1, 65536]");
  CHECK(refusal([](Settings& s) { s.thetas = {90 * kDegree}; }) == "thetas: is 90 degrees, must be in [0, 90)");
  CHECK(refusal([](Settings& s) { s.thetas = {std::nan("")}; }).find("thetas: is ") == 0);
  CHECK(refusal([](Settings& s) { s.scales = {1}; }) ==
        "no method of this study has windows whose scales could be swept");
  const auto windows = [&](std::vector<double> scales) {
    return refusal([&](Settings& s) {
      s.methods.push_back("ordinates");
      s.scales = scales;
    });
  };
  CHECK(windows({0}) == "scales: is 0, must be in [0.015625, 64]");
  CHECK(windows({1, 0.5, 1}) == "scales: 1 is given twice");
  CHECK(windows({std::nan("")}) == "scales: is nan, must be in [0.015625, 64]");
  CHECK(refusal([](Settings& s) { s.repeats = 0; }) == "repeats: is 0, must be in [1, 1000]");
  CHECK(refusal([](Settings& s) { s.directions = 1; }) == "reference directions: is 1, must be in [2, 1000000]");
  CHECK(refusal([](Settings& s) { s.tolerance = 0; }) == "reference tolerance: is 0, must be in [1e-9, 1]");
  CHECK(refusal([](Settings& s) { s.methods = {"emission"}; }) == "no method of this study has footprints to sweep");
}

// A method that is neither compared nor listed here has been forgotten.
TEST_CASE("A comparison of techniques has every method but variants of another", "[report]") {
  const std::set<std::string> variants{"emission-full", "dos-2",         "dos-two-pass", "cone-rays",
                                       "cone-rays-gl",  "rays-midpoint", "rays-pre",     "rays-gl-box"};
  for (const bool quick : {false, true}) {
    const StudyPlan plan = planStudy(techniqueSettings(quick, true), 60 * kDegree);
    std::set<std::string> methods;
    for (const StudyCase& one : plan.cases) {
      methods.insert(one.method);
      CHECK(one.size == plan.baseSize);
    }
    for (const StudyMethod& method : studyMethods())
      CHECK(methods.contains(method.name) != variants.contains(method.name));
  }
}

TEST_CASE("Each look is drawn by every technique that has its mode, and compared with its own reference", "[report]") {
  std::set<std::string> found;
  for (const StudyMethod& method : studyMethods()) {
    if (method.look == StudyLook::medium) continue;
    CAPTURE(method.name);
    found.insert(method.name);
    StudySettings settings = small();
    settings.methods = {method.name};
    settings.details.clear();
    const StudyPlan plan = planStudy(settings, 1);
    const ResolvedScene medium = studyScene(smokeScene(), plan, 1);
    const ResolvedScene made = caseScene(medium, plan.cases.front(), {10.0, 1.0});
    CHECK(supportsMode(made, made.technique));
    CHECK(isShaded(made) == (method.look == StudyLook::phong || needsSurfaces(method.look)));
    REQUIRE(plan.references.size() == settings.sizes.size());
    const ResolvedScene truth = referenceScene(medium, plan.referenceOf(plan.cases.front()));
    CHECK(truth.mode == made.mode);
    CHECK(truth.shading == made.shading);
    CHECK(plan.references.front().id() == lookName(method.look) + "-s" + std::to_string(plan.references.front().size));
    CHECK(medium.mode == Mode::integrate);
  }
  for (const ModeTraits& traits : modeTraits())
    for (const char* technique : {"rays", "rays-gl"})
      CHECK((traits.mode == Mode::integrate || found.contains(modeName(traits.mode) + "-" + technique)));
  CHECK(found.contains("phong-shear-warp"));
  CHECK(!found.contains("mip-shear-warp"));
}

TEST_CASE("Without surfaces there is nothing to compare of them", "[report]") {
  for (const std::string& name : techniqueSettings(true, false).methods) CHECK(!needsSurfaces(studyMethod(name).look));
  const std::vector<std::string> all = techniqueSettings(true, true).methods;
  CHECK(std::find(all.begin(), all.end(), "hybrid-rays-gl") != all.end());
}
