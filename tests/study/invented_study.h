// A study whose numbers are invented, for tests of what is made of numbers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <vector>

#include "support/test_scenes.h"
#include "umbrick/study/case_scene.h"
#include "umbrick/study/study_record.h"

namespace umbrick {

/// Returns a scene of no particular volume.
inline ResolvedScene smokeScene() {
  Scene scene;
  scene.transfer = loadTransferFunction("smoke");
  scene.orbit.reset();
  return resolvedAnywhere(scene);
}

/// Returns a complete study; errors fall with the slices as d^1, and times grow with slices and detail.
inline StudyRecord inventedStudy(const std::vector<int>& slices = {8, 16, 32}) {
  StudySettings settings;
  settings.methods = {"emission", "dos", "ordinates"};
  settings.slices = slices;
  settings.details["footprint"] = {2, 3};
  settings.details["directions"] = {4, 8};
  settings.bits = {{16, 16}, {32, 32}};
  settings.segments = {1, 2};
  settings.scales = {0.5, 1};
  settings.sizes = {16, 24};
  settings.thetas = {60 * kDegree, 80 * kDegree};
  const StudyPlan plan = planStudy(settings, 60 * kDegree);
  StudyRecord record{.plan = plan, .scene = studyScene(smokeScene(), plan, 1)};
  record.volume = {"/data/a <b> & \"c\".vdb", 12345, 0xdeadbeef};
  record.machine = {"a CPU & more", 2, "OSMesa: llvmpipe <x>", true, "0.0", "compiler", "gnuplot 5.4"};
  record.geometry = {10.0 / 3, 0.25};
  for (const StudyReference& what : record.plan.references)
    record.references.push_back({what, 1234.5, 17.25, {0.001, 0.01, 0.005, 1e-5, 0.999, 0.01}});
  for (const StudyReference& what : record.plan.references)
    if (what.model == Model::cone && what.size == record.plan.baseSize)
      record.modelErrors.push_back({what, {0.08, 0.3, 0.2, 0.05, 0.9, 0.1}});
  for (const StudyCase& what : record.plan.cases) {
    CaseResult result;
    result.what = what;
    result.spacing = record.geometry.extent / what.slices;
    const bool windows = studyMethod(what.method).windows;
    result.segments = caseScene(record.scene, what, record.geometry).sampling.segments;
    result.slicesDrawn = what.slices + 1;
    const double rmse = 0.3 * result.spacing / (1 + what.detail) + (what.bits.eye == 16 ? 0.01 : 0);
    result.error = {rmse, 5 * rmse, 4 * rmse, rmse * rmse, 1 - rmse, 2 * rmse};
    const double time = what.slices * (1.0 + what.detail) / (windows ? 96 : 32);
    result.timeRatio = {0.8 * time, 0.9 * time, time, 1.1 * time, 1.3 * time};
    result.caseMs = 40 * time;
    result.baselineMs = 40;
    result.pairs = 5;
    result.bufferBytes = 1000;
    result.textureBytes = 2000;
    result.load = 0.5;
    result.fragments = 100'000;
    result.passes = {windows ? 1.0 : 0.0, windows ? 3.0 : 0.0, 4};
    if (studyMethod(what.method).name == "light-volume") result.lightMs = 100;
    if (windows) {
      result.directions = what.detail;
      result.windowTexel = what.scale > 0 ? 0.25 / what.scale : 0.5;
      result.windowBytes = 3'000'000;
      result.windowUpdates = 5'000'000;
    }
    record.cases.push_back(result);
  }
  return record;
}

}  // namespace umbrick
