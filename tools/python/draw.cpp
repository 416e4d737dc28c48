// SPDX-License-Identifier: Apache-2.0
#include "draw.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "errors.h"
#include "job_thread.h"
#include "keywords.h"
#include "picture.h"
#include "scene_keywords.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/reference/reference.h"
#include "umbrick/render/picture_notes.h"
#include "umbrick/render/scene_drawer.h"
#include "umbrick/scene/capabilities.h"
#include "volume.h"

namespace umbrick::python {
namespace {
namespace py = pybind11;

// How pictures are made, besides their scene.
struct DrawOptions {
  EngineKind kind = EngineKind::automatic;
  RenderOptions render;
  bool progressive = false;
  ProgressiveOptions samples;
  bool target = false;

  AskedPicture asked() const { return {progressive, target, kind == EngineKind::cpu}; }
};

DrawOptions drawOptions(const Keywords& keywords) {
  DrawOptions options;
  if (const auto backend = keywords.get<std::string>("backend", kText))
    options.kind = parseName(kEngineKinds, *backend, "backend");
  if (const auto sweep = keywords.get<std::string>("light_sweep", kText))
    options.render.lightSweep = parseName(kLightSweeps, *sweep, "light_sweep");
  keywords.set("layers", kTruth, options.render.visibilityAndDepth);
  options.progressive = keywords.has("progressive") || keywords.has("max_seconds") || keywords.has("target_error");
  options.target = options.samples.refine = keywords.has("target_error");
  options.samples.passes = keywords.get<int>("progressive", kWhole).value_or(1 << 20);
  keywords.set("max_seconds", kNumber, options.samples.maxSeconds);
  keywords.set("target_error", kNumber, options.samples.targetError);
  keywords.set("seed", kWhole, options.samples.seed);
  if (options.samples.passes < 1)
    throw InvalidArgument("progressive: expected 1 or more, found " + std::to_string(options.samples.passes));
  for (const char* keyword : {"max_seconds", "target_error"})
    if (const auto number = keywords.get<double>(keyword, kNumber); number && !(*number > 0))
      throw InvalidArgument(std::string(keyword) + ": expected a number above 0, found " +
                            Keywords::shown(keywords.raw(keyword)));
  return options;
}

// A scene with its volume and what was chosen.
struct OpenedScene {
  std::shared_ptr<const Volume> volume;
  CompletedScene completed;
};

// Loads the volume of the scene, unless one is given, and completes the scene. Is called by a job.
OpenedScene openScene(const ScenePlea& plea, Scene scene, std::shared_ptr<const Volume> volume, JobWatch& watch) {
  if (!volume) {
    if (scene.volume.file.empty())
      throw InvalidArgument("volume: expected a Volume, an array or a path, or a scene that names one, found None");
    volume = std::make_shared<const Volume>(scene.volume, [&](double share) { watch.tell(share, "loading"); });
  }
  CompletedScene completed = completedScene(plea, std::move(scene), *volume);
  return {std::move(volume), std::move(completed)};
}

// Returns the volume that is given: none where a path stands for it, which the scene then names, or where the scene
// does.
std::shared_ptr<const Volume> volumeGiven(const py::object& volume, ScenePlea& plea) {
  if (volume.is_none()) return nullptr;
  if (!py::isinstance<py::str>(volume)) return volume.cast<const VolumeHandle&>().volume;
  plea.given.volume.file = volume.cast<std::string>();
  return nullptr;
}

VolumeUnits unitsOf(const Volume& volume) {
  const ScalarGrid& grid = volume.grid();
  return {grid.metadata("length_unit"), grid.metadata("value_unit"), grid.metadata("space")};
}

void noteNonFinite(std::uint64_t voxels, PictureHandle& picture) {
  if (voxels > 0) picture.notes.push_back(std::to_string(voxels) + " voxels are not finite and count as background");
}

void noteEmpty(const ResolvedScene& scene, const Volume& volume, const AskedScene& words, PictureHandle& picture) {
  if (const auto empty = describeEmptyPicture(picture.colour, scene, volume, words)) picture.notes.push_back(*empty);
}

// The scene that a file names: one sample of a pixel's area is each pass, unless all go through its centre.
ResolvedScene recordedScene(const ProgressivePicture& made, bool area) {
  ResolvedScene scene = made.scene;
  scene.sampling.pixelSamples = area ? std::clamp(made.passes, 1, kMostPixelSamples) : 1;
  return scene;
}

// Draws a scene as umbrick render does. Is called by a job.
PictureHandle draw(SceneDrawer& drawer, const Volume& volume, const ResolvedScene& resolved, const DrawOptions& options,
                   const AskedScene& words, JobWatch& watch) {
  PictureHandle picture;
  Renderer& renderer = drawer.rendererFor(resolved);
  const Stopwatch drawing;
  if (options.progressive) {
    ProgressiveOptions samples = options.samples;
    samples.pixelArea = !(words.has("samples") && resolved.sampling.pixelSamples == 1);
    ProgressivePicture made = renderProgressive(renderer, samples, [&](const ProgressivePicture& so) {
      watch.tell(samples.passes < 1 << 20 ? double(so.passes) / samples.passes : 0, "averaging");
      return true;
    });
    picture.progressive = {made.passes, made.seconds, made.error, made.reachedTarget, samples.seed};
    const ResolvedScene recorded = recordedScene(made, samples.pixelArea);
    picture.notes = notesOn(made.picture, recorded, words);
    takePicture(std::move(made.picture), recorded, picture);
    if (options.target && !made.reachedTarget)
      picture.notes.push_back("the error asked for, " + std::to_string(samples.targetError) + ", is not reached");
  } else {
    Picture made = renderer.render();
    picture.notes = notesOn(made, renderer.scene(), words);
    takePicture(std::move(made), renderer.scene(), picture);
  }
  picture.ms = drawing.elapsedMs();
  picture.engine = drawer.engine().description;
  picture.units = unitsOf(volume);
  noteNonFinite(drawer.bricks().nonFiniteVoxels, picture);
  noteEmpty(*picture.scene, volume, words, picture);
  return picture;
}

void tellChosen(const CompletedScene& completed, const AskedScene& words, PictureHandle& picture) {
  for (const auto& [option, value] : completed.chosen) picture.chosen.emplace_back(words.nameOf(option), value);
  picture.reasons = completed.reasons;
}

// Lets a renderer tell its progress to the watch of the job at hand.
std::function<void(double)> progressTo(JobWatch*& watch) {
  return [&watch](double share) {
    if (watch) watch->tell(share, "rendering");
  };
}

PictureHandle render(const py::object& volume, const py::object& sceneGiven, const py::dict& sceneKeywords,
                     const py::dict& values, const py::object& progress) {
  ScenePlea plea = readScenePlea(sceneGiven, sceneKeywords);
  DrawOptions options = drawOptions(Keywords(values));
  std::shared_ptr<const Volume> given = volumeGiven(volume, plea);
  Scene scene = askedScene(plea, plea.given, {.model = Model::cone, .emission = !given});
  fitToPicture(plea, options.asked(), scene);
  PictureHandle picture;
  runJob("render", progress, [&](JobWatch& watch) {
    JobWatch* present = &watch;
    options.render.progress = progressTo(present);
    const OpenedScene opened = openScene(plea, std::move(scene), std::move(given), watch);
    SceneDrawer drawer(opened.volume, options.kind, options.render, options.progressive);
    picture = draw(drawer, *opened.volume, opened.volume->resolve(opened.completed.scene), options, plea, watch);
    tellChosen(opened.completed, plea, picture);
  });
  return picture;
}

// --- a renderer that lives ---

class LiveRenderer {
 public:
  LiveRenderer(const VolumeHandle& volume, const py::object& scene, const py::dict& keywords, const py::dict& values,
               const py::object& progress)
      : volume_(volume.volume), options_(drawOptions(Keywords(values))) {
    const ScenePlea plea = readScenePlea(scene, keywords);
    Scene asked = askedScene(plea, plea.given, {.model = Model::cone});
    fitToPicture(plea, options_.asked(), asked);
    options_.render.progress = progressTo(watch_);
    job(progress, [&](JobWatch& watch) {
      OpenedScene opened = openScene(plea, std::move(asked), volume_, watch);
      completed_ = std::move(opened.completed);
      seen_ = volume_->visibleBounds(*completed_.scene.transfer);
      auto drawer = std::make_unique<SceneDrawer>(volume_, options_.kind, options_.render, options_.progressive);
      drawer->rendererFor(settle(completed_.scene));
      drawer_ = std::move(drawer);
    });
  }
  // What draws by OpenGL ends on the thread of its context.
  ~LiveRenderer() {
    try {
      job(py::none(), [&](JobWatch&) { drawer_.reset(); });
    } catch (py::error_already_set& error) {
      error.discard_as_unraisable("Renderer");  // a signal, which ends nothing here
    }
  }
  LiveRenderer(const LiveRenderer&) = delete;
  LiveRenderer& operator=(const LiveRenderer&) = delete;

  void set(const py::dict& keywords, const py::object& progress) {
    const ScenePlea plea = changePlea(completed_.scene, keywords);
    Scene next = askedScene(plea, plea.given);
    job(progress, [&](JobWatch&) {
      CompletedScene completed = completedScene(plea, std::move(next), *volume_, {.transfer = {}, .seen = seen_});
      drawer_->rendererFor(settle(completed.scene));
      completed_.scene = std::move(completed.scene);
    });
  }

  PictureHandle render(const py::object& progress) {
    PictureHandle picture;
    const ScenePlea words;
    job(progress,
        [&](JobWatch& watch) { picture = draw(*drawer_, *volume_, settle(completed_.scene), options_, words, watch); });
    tellChosen(completed_, words, picture);
    return picture;
  }

  std::string sceneText() const { return printScene(completed_.scene); }

 private:
  // An orbit stays around what was seen first, so that the camera stays where the transfer function changes, and bricks
  // keep the size that they were cut with.
  ResolvedScene settle(Scene& scene) const {
    ResolvedScene resolved =
        scene.orbit ? volume_->resolve(scene, *seen_) : volume_->resolve(scene, volume_->worldBounds());
    scene.bricks.interior = resolved.bricks.interior;
    return resolved;
  }

  void job(const py::object& progress, const JobThread::Job& work) {
    thread_.run("Renderer", progress, [&](JobWatch& watch) {
      watch_ = &watch;
      try {
        work(watch);
      } catch (...) {
        watch_ = nullptr;
        throw;
      }
      watch_ = nullptr;
    });
  }

  std::shared_ptr<const Volume> volume_;
  DrawOptions options_;
  CompletedScene completed_;
  std::optional<Box> seen_;    // what orbits turn around, world units
  JobWatch* watch_ = nullptr;  // of the job at hand
  std::unique_ptr<SceneDrawer> drawer_;
  JobThread thread_;
};

// --- the reference ---

PictureHandle reference(const py::object& volume, const py::object& sceneGiven, const py::dict& sceneKeywords,
                        const py::dict& values, const py::object& progress) {
  const Keywords keywords(values);
  ScenePlea plea = readScenePlea(sceneGiven, sceneKeywords);
  ReferenceOptions options;
  if (const auto integrator = keywords.get<std::string>("integrator", kText))
    options.integrator = parseName(kIntegrators, *integrator, "integrator");
  keywords.set("reference_directions", kWhole, options.directions);
  keywords.set("tolerance", kNumber, options.tolerance);
  keywords.set("step", kNumber, options.step);
  keywords.set("standard_error", kNumber, options.standardError);
  keywords.set("seed", kWhole, options.seed);
  keywords.set("threads", kWhole, options.threads);
  const auto paths = keywords.get<int>("paths", kWhole);
  // If no number of paths is given, as many are traced as the standard error needs.
  options.samples = paths.value_or(options.standardError > 0 ? 1'000'000'000 : options.samples);
  const bool layers = keywords.get<bool>("layers", kTruth).value_or(false);
  std::shared_ptr<const Volume> given = volumeGiven(volume, plea);
  const bool emission = !given && options.integrator == Integrator::quadrature;
  Scene scene = askedScene(plea, plea.given, {.model = Model::cone, .emission = emission});
  PictureHandle picture;
  runJob("reference", progress, [&](JobWatch& watch) {
    const OpenedScene opened = openScene(plea, std::move(scene), std::move(given), watch);
    const ResolvedScene resolved = opened.volume->resolve(opened.completed.scene);
    // Of paths that nobody has counted there are enough for each sample of a pixel to have two.
    if (!paths) options.samples = std::max(options.samples, 2 * resolved.sampling.pixelSamples);
    options.progress = [&](double share) { return watch.goOn(share, "reference"); };
    const Stopwatch drawing;
    ReferencePicture made = renderReference(opened.volume->grid(), resolved, options);
    if (!made.complete) watch.tell(1, "reference");  // which ends the job, since its caller has stopped it
    const bool projection = traitsOf(resolved.mode).projection;
    Picture kept;
    kept.colour = std::move(made.colour);
    if (layers && !projection) {
      kept.visibility = std::move(made.visibility);
      kept.depth = std::move(made.depth);
    }
    if (layers || projection) kept.layers = std::move(made.layers);
    takePicture(std::move(kept), resolved, picture);
    if (options.integrator == Integrator::monteCarlo)
      picture.layers.insert(picture.layers.begin(), {"standardError", std::move(made.standardError)});
    picture.ms = drawing.elapsedMs();
    picture.engine = "reference";
    picture.units = unitsOf(*opened.volume);
    noteNonFinite(made.stats.nonFiniteVoxels, picture);
    if (made.stats.unconvergedPixels > 0)
      picture.notes.push_back(std::to_string(made.stats.unconvergedPixels) +
                              " pixels took all samples and have a larger standard error");
    noteEmpty(resolved, *opened.volume, plea, picture);
    tellChosen(opened.completed, plea, picture);
  });
  return picture;
}

}  // namespace

void addDrawing(py::module_& module) {
  module.def("scene_keywords", sceneKeywords);
  module.def("render", render);
  module.def("reference", reference);
  py::class_<LiveRenderer>(module, "Renderer", "A renderer that lives as long as its volume is looked at.")
      .def(py::init<const VolumeHandle&, const py::object&, const py::dict&, const py::dict&, const py::object&>())
      .def("set", &LiveRenderer::set)
      .def("render", &LiveRenderer::render)
      .def_property_readonly("scene_text", &LiveRenderer::sceneText);
}

}  // namespace umbrick::python
