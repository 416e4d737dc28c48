// SPDX-License-Identifier: Apache-2.0
#include "study/study_run.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/json_writer.h"
#include "study/study_timing.h"
#include "umbrick/core/error.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/image/exr.h"
#include "umbrick/reference/reference.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/shade/prepare.h"
#include "umbrick/slice/proxy_slices.h"
#include "umbrick/study/case_scene.h"
#include "umbrick/sweep/swept_bricks.h"

namespace umbrick {
namespace {

BrickOptions bricksOf(const ScalarGrid& grid, const ResolvedScene& scene) {
  return requiredBricks(scene, grid.indexToWorld(), grid.worldBounds());
}

RenderOptions quietly() {
  RenderOptions options;
  options.countFragments = false;  // only pictures are to be timed
  return options;
}

// Returns seconds on two cores with a software rasteriser: only the ratio of steps matters.
double estimatedWork(const StudyReference& what, const StudySettings& settings) {
  if (!traitsOf(what.model).occlusion) return 1;
  const double whole = traitsOf(what.model).sphere ? 2 : 1;
  return 1.5 * whole * 6e-6 * what.size * what.size * settings.directions;
}
double estimatedWork(const StudyCase& what, const StudySettings& settings) {
  const double pixels = 0.4 * what.size * what.size, baseline = pixels * kBaselineSlices / 4e7 + 0.02;
  const double cost = studyMethod(what.method).work(what.detail);
  return (settings.repeats + 3) * (pixels * what.slices * cost / 4e7 + 1e-4 * what.slices + baseline);
}

// Returns a key. Two references with the same key are the same picture: of one volume and scene, integrated with
// the same care.
std::string referenceKey(const StudyRecord& record, const StudyReference& what) {
  const ReferenceOptions options = referenceOptions(record.plan.settings);
  return "volume " + std::to_string(record.volume.crc32) + ", directions " + std::to_string(options.directions) +
         ", tolerance " + jsonNumber(options.tolerance) + ", " + printScene(referenceScene(record.scene, what));
}

}  // namespace

double visibleExtent(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene) {
  StudyCase probe;
  probe.method = "emission";
  probe.slices = 1;
  probe.size = 64;  // so many pixels are enough to know what lies in the picture
  const double voxelEdge = shortestVoxelEdge(grid.indexToWorld()), spacing = 0.5 * voxelEdge;
  const ResolvedScene fine = caseScene(scene, probe, {spacing, voxelEdge});
  const std::unique_ptr<Bricks> bricks = cutGrid(grid, bricksOf(grid, fine), fine.bricks.bricked);
  SliceRenderer renderer(context, *bricks, fine, quietly());
  const auto slices = static_cast<double>(renderer.render().stats.slices);
  if (slices == 0)
    throw InvalidArgument(scene.volume.file.string() +
                          ": nothing to study: the transfer function or the camera shows nothing of it");
  return slices * spacing;
}

int leastSlices(const ScalarGrid& grid, const ResolvedScene& scene, double extent) {
  if (scene.sampling.quadrature != Quadrature::preintegrated) return 1;
  // A slab reaches at most to the other side of a brick, see requiredApron.
  const glm::dvec3 reach = slabReach(indexView(scene.camera, grid.indexToWorld()), extent);
  const int interior = scene.bricks.interior > 0 ? scene.bricks.interior : kMostInterior;
  return std::max(1, static_cast<int>(std::ceil(std::max({reach.x, reach.y, reach.z}) / (interior - 0.5) - 1e-9)));
}

void checkCases(const GlContext& context, const ScalarGrid& grid, const StudyRecord& record) {
  for (const StudyCase& what : record.plan.cases) {
    const ResolvedScene scene = caseScene(record.scene, what, record.geometry);
    if (std::max(scene.camera.width, scene.camera.height) > context.maxTextureEdge2d())
      throw InvalidArgument("sizes: " + std::to_string(scene.camera.width) + " x " +
                            std::to_string(scene.camera.height) + " pixels are beyond the driver's limit of " +
                            std::to_string(context.maxTextureEdge2d()));
    try {
      validateScene(scene);
      requiredApron(scene, grid.indexToWorld());
    } catch (const InvalidArgument& error) {
      throw InvalidArgument("slices: " + std::to_string(what.slices) + " are too few: " + error.what());
    }
  }
}

struct StudyRun::Baseline {
  int size;
  std::shared_ptr<ResidentVolume> volume;
  SliceRenderer renderer;
  // Returns the median time of so many frames, which a reference's time is divided by.
  double medianMs(int frames) {
    renderer.render();
    std::vector<double> times;
    for (int i = 0; i < frames; ++i) {
      const Stopwatch watch;
      renderer.render();
      times.push_back(watch.elapsedMs());
    }
    return spreadOf(times).median;
  }
};

StudyRun::StudyRun(const GlContext& context, const ScalarGrid& grid, StudyRecord& record, const StudyFolder& folder,
                   const StudyOptions& options)
    : context_(context),
      grid_(grid),
      record_(record),
      folder_(folder),
      options_(options),
      resident_(context, record.scene.bricks.budgetMiB << 20) {}

StudyRun::~StudyRun() = default;

void StudyRun::measure() {
  const StudyPlan& plan = record_.plan;
  // A reference that somebody has deleted is made again, as long as something is compared with it.
  if (!record_.complete())
    std::erase_if(record_.references, [&](const ReferenceResult& result) {
      return !std::filesystem::exists(folder_.reference(result.what.id()));
    });
  std::vector<StudyReference> references;
  for (const StudyReference& what : plan.references)
    if (!record_.find(what)) references.push_back(what);
  std::vector<StudyCase> cases;
  for (const StudyCase& what : plan.cases)
    if (!record_.find(what)) cases.push_back(what);
  for (const StudyReference& what : references) work_ += estimatedWork(what, plan.settings);
  for (const StudyCase& what : cases) work_ += estimatedWork(what, plan.settings);

  for (const StudyReference& what : references) {
    if (!measureReference(what)) return;
    done_ += estimatedWork(what, plan.settings);
  }
  for (const StudyReference& what : plan.references)
    if (traitsOf(what.model).cone && what.size == plan.baseSize && !record_.findModelError(what))
      measureModelError(what);
  for (const StudyCase& what : cases) {
    if (!report(what.id(), 0)) return;
    measureCase(what);
    done_ += estimatedWork(what, plan.settings);
  }
  report("done", 0);
}

std::uint64_t StudyRun::nonFiniteVoxels() const {
  return bricks_.empty() ? 0 : bricks_.begin()->second->nonFiniteVoxels;
}

bool StudyRun::report(const std::string& step, double share) {
  if (!options_.progress) return true;
  const double done = work_ > 0 ? std::min(1.0, (done_ + share) / work_) : 1;
  return options_.progress({done, step, record_.cases.size(), record_.plan.cases.size()});
}

const Bricks& StudyRun::bricksFor(const ResolvedScene& scene) {
  const BrickOptions options = bricksOf(grid_, scene);
  std::unique_ptr<Bricks>& bricks = bricks_[{options.interior, options.apron, scene.bricks.bricked}];
  if (!bricks) bricks = cutGrid(grid_, options, scene.bricks.bricked);
  return *bricks;
}

std::shared_ptr<ResidentVolume> StudyRun::residentFor(const ResolvedScene& scene) {
  const Bricks& bricks = bricksFor(scene);
  return resident_.get(bricks, atlasOptions(scene, bricks));
}

StudyRun::Baseline& StudyRun::baselineOf(int size) {
  if (!baseline_ || baseline_->size != size) {
    baseline_.reset();
    const ResolvedScene scene = baselineScene(record_.scene, size, record_.geometry);
    const auto volume = residentFor(scene);
    baseline_.reset(new Baseline{size, volume, SliceRenderer(*volume, scene, quietly())});
  }
  return *baseline_;
}

// --- references ---

bool StudyRun::integrate(const StudyReference& what, bool coarser, Image& image, double& milliseconds) {
  ReferenceOptions options = referenceOptions(record_.plan.settings, coarser);
  // The coarser reference has half of the directions: it is a third of the work of both.
  const double work = estimatedWork(what, record_.plan.settings);
  const std::string step = "reference " + what.id() + (coarser ? ", its own error" : "");
  options.progress = [&](double share) { return report(step, work * (coarser ? (2 + share) / 3 : 2 * share / 3)); };
  ReferencePicture picture = renderReference(grid_, referenceScene(record_.scene, what), options);
  image = std::move(picture.colour);
  milliseconds = picture.stats.integrateMs;
  return picture.complete;
}

bool StudyRun::measureReference(const StudyReference& what) {
  constexpr int kFrames = 3;
  const std::filesystem::path file = folder_.reference(what.id());
  const std::string key = referenceKey(record_, what);
  Baseline& baseline = baselineOf(what.size);
  ReferenceResult result;
  result.what = what;
  const double before = baseline.medianMs(kFrames);
  Image image, coarser;
  if (!integrate(what, false, image, result.integrateMs)) return false;
  result.timeRatio = result.integrateMs / spreadOf({before, baseline.medianMs(kFrames)}).median;
  double ignored = 0;
  if (!integrate(what, true, coarser, ignored)) return false;
  result.coarser = measureError(coarser, image);
  ExrOptions options;
  options.pixel = ExrPixel::float32;
  options.metadata = {{"umbrick.study.reference", key},
                      {"umbrick.scene", printScene(referenceScene(record_.scene, what))}};
  writeExr(file, {{"", image}}, options);
  show(what.id(), what.model, image, nullptr);
  references_[what.id()] = std::move(image);
  record_.references.push_back(result);
  save();
  return true;
}

const Image& StudyRun::referenceImage(const StudyReference& what) {
  const auto known = references_.find(what.id());
  if (known != references_.end()) return known->second;
  const std::filesystem::path file = folder_.reference(what.id());
  ExrFile stored = readExr(file);
  const auto key = stored.metadata.find("umbrick.study.reference");
  if (key == stored.metadata.end() || key->second != referenceKey(record_, what))
    throw InvalidArgument(file.string() +
                          ": not the reference that this version makes for this study; give another folder");
  return references_[what.id()] = std::move(stored.layers.front().image);
}

void StudyRun::measureModelError(const StudyReference& cone) {
  const StudyReference ambient{Model::ambient, cone.size, 0, StudyLook::medium};
  const Image &test = referenceImage(cone), &truth = referenceImage(ambient);
  record_.modelErrors.push_back({cone, measureError(test, truth)});
  show(cone.id(), cone.model, test, &truth);
  save();
}

// --- cases ---

StudyRun::CaseRenderer StudyRun::rendererFor(const ResolvedScene& scene, bool onCpu, const RenderOptions& options) {
  CaseRenderer made;
  if (onCpu) {
    const BrickOptions cut = sweptBricks(scene);
    std::unique_ptr<Bricks>& bricks = bricks_[{cut.interior, -cut.apron, scene.bricks.bricked}];
    if (!bricks) bricks = cutGrid(grid_, cut, scene.bricks.bricked);
    made.renderer = makeRenderer(*bricks, scene, options);
  } else {
    made.volume = residentFor(scene);
    made.renderer = makeRenderer(*made.volume, scene, options);
  }
  return made;
}

RenderStats StudyRun::countedPicture(const ResolvedScene& scene, bool onCpu) {
  RenderOptions options;
  options.timePasses = true;
  const CaseRenderer made = rendererFor(scene, onCpu, options);
  const double lightMs = made.renderer->render().stats.lightMs;  // uploads bricks and compiles shaders
  RenderStats stats = made.renderer->render().stats;
  stats.lightMs = lightMs;
  return stats;
}

void StudyRun::measureCase(const StudyCase& what) {
  const ResolvedScene scene = caseScene(record_.scene, what, record_.geometry);
  const bool onCpu = studyMethod(what.method).onCpu;
  const StudyReference reference = record_.plan.referenceOf(what);
  const Image& truth = referenceImage(reference);
  Baseline& baseline = baselineOf(what.size);
  Picture picture;
  CaseResult result;
  result.what = what;
  result.load = loadAverage();
  TimingOptions timing;
  timing.pairs = record_.plan.settings.repeats;
  PairedTimes times;
  {
    const CaseRenderer made = rendererFor(scene, onCpu, quietly());
    times = timePairs([&] { baseline.renderer.render(); }, [&] { picture = made.renderer->render(); }, timing);
  }
  result.timeRatio = spreadOf(ratios(times.caseMs, times.baselineMs));
  result.caseMs = spreadOf(times.caseMs).median;
  result.baselineMs = spreadOf(times.baselineMs).median;
  result.pairs = static_cast<int>(times.caseMs.size());
  result.spacing = scene.sampling.spacing;
  result.segments = scene.sampling.segments;
  result.slicesDrawn = picture.stats.slices;
  result.bufferBytes = picture.stats.bufferBytes;
  result.textureBytes = picture.stats.textureBytes;
  const RenderStats counted = countedPicture(scene, onCpu);
  result.fragments = counted.fragments;
  result.passes = counted.passes;
  result.directions = counted.directions;
  // What a medium reflects is computed for each picture and is in its time.
  if (traitsOf(reference.model).occlusion) result.lightMs = counted.lightMs;
  result.windowTexel = counted.windowTexel;
  result.windowBytes = counted.windowBytes;
  result.windowUpdates = counted.windowUpdates;
  result.error = measureError(picture.colour, truth);
  show(what.id(), reference.model, picture.colour, &truth);
  record_.cases.push_back(result);
  save();
}

void StudyRun::show(const std::string& id, Model model, const Image& image, const Image* truth) const {
  if (options_.picture) options_.picture({id, model, image, truth});
}

void StudyRun::save() const { writeTextFile(folder_.record(), printRecord(record_)); }

}  // namespace umbrick
