// SPDX-License-Identifier: Apache-2.0
#include "measure.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <numbers>

#include "job_thread.h"
#include "keywords.h"
#include "scene_keywords.h"
#include "umbrick/check/invariants.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/study/study.h"
#include "volume.h"

namespace umbrick::python {
namespace {
namespace py = pybind11;

constexpr int kCheckEdge = 96;  // pixels: laws hold for each pixel, and brick faces cross pictures of any size

Backend backendOf(const Keywords& keywords) {
  const auto backend = keywords.get<std::string>("backend", kText);
  return backend ? parseName(kBackends, *backend, "backend") : Backend::automatic;
}

ResolvedScene resolvedFor(const ScenePlea& plea, Scene scene, const Volume& volume) {
  scene = completedScene(plea, std::move(scene), volume).scene;
  return resolveScene(scene, volume.worldBounds(), volume.indexToWorld());
}

// The scene of the emission's pictures, with a model beside those that keywords name.
Scene checkedScene(ScenePlea plea, Model model) {
  if (model == Model::emission) plea.quality.reset();
  if (model == Model::cone) plea.fields["model"] = [](Scene& scene) { scene.model = Model::cone; };
  Scene scene = askedScene(plea, plea.given);
  if (!plea.has("size")) scene.camera.width = scene.camera.height = kCheckEdge;
  return scene;
}

py::dict resultOf(const InvariantResult& r) {
  py::dict out;
  out["invariant"] = r.invariant;
  out["name"] = r.name;
  out["measured"] = r.measured;
  out["value"] = r.value;
  out["limit"] = r.limit;
  out["limit_from"] = r.limitFrom;
  out["samples"] = r.samples;
  out["excluded"] = r.excluded;
  out["passed"] = r.passed;
  out["detail"] = r.detail;
  return out;
}

py::dict check(const VolumeHandle& handle, const py::object& sceneGiven, const py::dict& sceneKeywords,
               const py::dict& values, const py::object& progress) {
  const Keywords keywords(values);
  ScenePlea plea = readScenePlea(sceneGiven, sceneKeywords);
  for (const char* option : {"model", "technique", "no-culling", "unbricked"})
    if (plea.has(option))
      throw InvalidArgument(plea.nameOf(option) +
                            ": expected no such keyword, since the check decides what is compared");
  CheckOptions options;
  keywords.set("edges", "a list of whole numbers", options.edges);
  for (const int edge : options.edges)
    if (edge < 8 || edge > 256 || edge % 8 != 0)
      throw InvalidArgument("edges: expected multiples of 8 from 8 to 256, found " + std::to_string(edge));
  keywords.set("slices", kWhole, options.probedSlices);
  keywords.set("seed", kWhole, options.seed);
  const Backend backend = backendOf(keywords);
  const Scene plain = checkedScene(plea, Model::emission), lit = checkedScene(plea, Model::cone);
  const Volume& volume = *handle.volume;
  std::vector<InvariantResult> results;
  std::string engine, scene;
  runJob("check", progress, [&](JobWatch& watch) {
    const ResolvedScene resolved = resolvedFor(plea, plain, volume);
    Scene cone = completedScene(plea, plain, volume).scene;
    cone.sampling = lit.sampling;
    cone.spacingUnit = lit.spacingUnit;
    cone.occlusion = lit.occlusion;
    options.cone = resolveScene(cone, volume.worldBounds(), volume.indexToWorld());
    const auto context = createGlContext(backend);
    options.progress = [&](const std::string& step, double done) { return watch.goOn(done, step); };
    results = checkInvariants(*context, volume.grid(), resolved, options);
    engine = context->description();
    scene = printScene(resolved);
  });
  py::list rows;
  for (const InvariantResult& result : results) rows.append(resultOf(result));
  py::dict out;
  out["passed"] = std::all_of(results.begin(), results.end(), [](const auto& r) { return r.passed && r.complete; });
  out["engine"] = engine;
  out["seed"] = options.seed;
  out["scene_text"] = scene;
  out["invariants"] = rows;
  return out;
}

StudySettings studySettings(const Keywords& keywords, bool surfaces) {
  const bool quick = keywords.get<bool>("quick", kTruth).value_or(false);
  StudySettings settings = keywords.get<bool>("techniques", kTruth).value_or(false) ? techniqueSettings(quick, surfaces)
                           : quick                                                  ? quickStudySettings()
                                                                                    : StudySettings{};
  if (keywords.has("methods")) {
    keywords.set("methods", "a list of names", settings.methods);
    // The values of a quick study belong to its own methods.
    std::erase_if(settings.details, [&](const auto& detail) {
      return std::ranges::none_of(settings.methods,
                                  [&](const auto& name) { return studyMethod(name).detail.name == detail.first; });
    });
  }
  constexpr const char* kList = "a list of whole numbers";
  keywords.set("slices", kList, settings.slices);
  keywords.set("segments", kList, settings.segments);
  keywords.set("sizes", kList, settings.sizes);
  keywords.set("scales", "a list of numbers", settings.scales);
  if (const auto details = keywords.get<std::map<std::string, std::vector<int>>>("details", "lists by name"))
    for (const auto& [name, list] : *details) settings.details[name] = list;
  if (const auto bits = keywords.get<std::vector<std::pair<int, int>>>("bits", "pairs of eye and occlusion bits")) {
    settings.bits.clear();
    for (const auto& [eye, occlusion] : *bits) settings.bits.push_back({eye, occlusion});
  }
  if (const auto degrees = keywords.get<std::vector<double>>("thetas", "a list of numbers")) {
    settings.thetas.clear();
    for (const double theta : *degrees)
      settings.thetas.push_back(static_cast<double>(theta * (std::numbers::pi_v<long double> / 180)));
  }
  keywords.set("repeats", kWhole, settings.repeats);
  keywords.set("reference_directions", kWhole, settings.directions);
  keywords.set("reference_tolerance", kNumber, settings.tolerance);
  return settings;
}

// @return the record as JSON
std::string study(const VolumeHandle& handle, const std::filesystem::path& folder, const py::object& sceneGiven,
                  const py::dict& sceneKeywords, const py::dict& values, const py::object& progress) {
  const Keywords keywords(values);
  if (!handle.ofFile)
    throw InvalidArgument("volume: expected one that was opened from a file, by which the record knows it, found " +
                          handle.volume->name() + "; save it before");
  const ScenePlea plea = readScenePlea(sceneGiven, sceneKeywords);
  Scene asked = askedScene(plea, plea.given);
  StudySettings settings = studySettings(keywords, traitsOf(asked.mode).surfaces || !asked.surfaces.empty());
  if (keywords.get<bool>("techniques", kTruth).value_or(false) && settings.thetas.empty())
    settings.thetas = {asked.occlusion.aperture};
  planStudy(settings, asked.occlusion.aperture);  // refuses wrong settings before anything is drawn
  const Backend backend = backendOf(keywords);
  const Volume& volume = *handle.volume;
  std::string record;
  runJob("study", progress, [&](JobWatch& watch) {
    const ResolvedScene resolved = volume.resolve(completedScene(plea, std::move(asked), volume).scene);
    const auto context = createGlContext(backend);
    StudyOptions options;
    options.progress = [&](const StudyProgress& at) { return watch.goOn(at.share, at.step); };
    record = printRecord(runStudy(*context, volume.grid(), resolved, settings, folder, options).study);
  });
  return record;
}

py::tuple suggest(const VolumeHandle& handle) {
  std::string text, reason;
  runJob("tf_auto", py::none(), [&](JobWatch&) {
    const SuggestedTransfer suggested = suggestTransfer(*handle.volume);
    text = printTransferFunction(suggested.transfer);
    reason = suggested.reason;
  });
  return py::make_tuple(text, reason);
}

py::dict presets() {
  py::dict out;
  for (const std::string& name : transferPresets()) out[py::str(name)] = describeTransferFunction(name);
  return out;
}

}  // namespace

void addMeasures(py::module_& module) {
  module.def("check", check);
  module.def("study", study);
  module.def("tf_auto", suggest);
  module.def("tf_list", presets);
  module.def("tf_load", [](const std::string& name) { return printTransferFunction(loadTransferFunction(name)); });
}

}  // namespace umbrick::python
