// SPDX-License-Identifier: Apache-2.0
#include "umbrick/shade/ray_caster.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "shade/brick_parts.h"
#include "shade/brick_runs.h"
#include "shade/constants.h"
#include "shade/ray_pass.h"
#include "shade/view_planes.h"
#include "shade/visible_bricks.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {

void checkScene(const ResolvedScene& scene, const ResidentVolume& resident) {
  if (!supports(Method::lightVolume, scene.model))
    throw InvalidArgument("model: " + modelName(scene.model) +
                          " is integrated by the reference alone; rays render emission, cone, ambient and lights");
  if (occlusionMethod(scene).value_or(Method::lightVolume) != Method::lightVolume)
    throw InvalidArgument("method: " + methodName(scene.method) +
                          " is one of slices; rays take light from a light volume");
  checkOnGl(scene, resident);
}

// What of a scene is held beyond a picture.
struct Held {
  std::optional<TransferLookup> transfer;
  std::optional<BrickSelection> bricks;
  std::optional<RayTargets> targets;
};

}  // namespace

class RayCaster::Implementation {
 public:
  Implementation(ResidentVolume& resident, const RenderOptions& options)
      : gl_(resident.context().gl()),
        resident_(resident),
        volume_(resident.volume()),
        options_(options),
        light_(resident, options.lightSweep),
        parts_(resident.volume()) {}

  /// Makes anew what another scene asks for or, when something throws, nothing.
  void update(const ResolvedScene& next, const ResolvedScene* before) {
    checkScene(next, resident_);
    resetGlState(gl_);
    drawn_ = false;
    const bool lookup = !before || before->transfer != next.transfer ||
                        before->sampling.spacing != next.sampling.spacing ||
                        before->sampling.quadrature != next.sampling.quadrature;
    const bool selection =
        lookup || before->bricks.culling != next.bricks.culling || sharingOf(*before) != sharingOf(next);
    Held made;
    if (lookup) made.transfer.emplace(gl_, next.transfer, next.sampling, volume_, resident_.format());
    const TransferLookup& transfer = lookup ? *made.transfer : *held_.transfer;
    const bool background = showsBackground(transfer, volume_);
    bool fits = fits_;
    if (selection) {
      made.bricks.emplace(resident_.atlas(), visibleBricks(resident_, transfer, next.bricks.culling, background),
                          sharingOf(next));
      fits = made.bricks->reserve();
    }
    if (!before || before->camera.width != next.camera.width || before->camera.height != next.camera.height)
      made.targets.emplace(
          gl_,
          TargetOptions{.width = next.camera.width, .height = next.camera.height, .aux = options_.visibilityAndDepth});
    if (selection) ++version_;
    if (made.transfer) held_.transfer = std::move(made.transfer);
    if (made.bricks) held_.bricks = std::move(made.bricks);
    if (made.targets) held_.targets = std::move(made.targets);
    background_ = background;
    fits_ = fits;
  }

  std::optional<RaySampling> sampling(const ResolvedScene& scene) const {
    const double segment = scene.sampling.spacing / scene.sampling.segments;
    if (!withinApron(indexView(scene.camera, volume_.indexToWorld), segment)) return std::nullopt;
    return RaySampling{segment, shortestVoxelEdge(volume_.indexToWorld)};
  }

  void draw(const ResolvedScene& scene, const RenderSample& sample) {
    drawn_ = false;
    stats_ = {};
    resetGlState(gl_);
    const Stopwatch geometry;
    IndexView view = indexView(scene.camera, volume_.indexToWorld);
    if (!withinApron(view, scene.sampling.spacing / scene.sampling.segments))
      throw InvalidArgument("render: segments of rays reach beyond the apron of " +
                            std::to_string(volume_.layout.apron) + " voxels");
    view.seeThrough(sample.pixel);
    const std::vector<glm::dvec4> planes = viewPlanes(scene, volume_, background_);
    checkPlanes(planes.size());
    stats_.geometryMs = geometry.elapsedMs();
    const bool lit = occlusionMethod(scene).has_value();
    if (lit) light_.update(scene, sample, view, planes, *held_.transfer, *held_.bricks);
    held_.targets->clear(gl_);
    const IndexBox medium = mediumBox(scene.transfer, volume_.domain);
    const RayScene rays{gl_,
                        scene,
                        view,
                        planes,
                        {glm::dvec3(medium.min), glm::dvec3(medium.max)},
                        *held_.transfer,
                        *held_.bricks,
                        lit ? &light_ : nullptr,
                        *held_.targets,
                        options_.progress};
    pass_.begin(rays);
    const std::uint64_t uploadedBefore = resident_.atlas().uploadedBricks();
    drawRuns(rays, sample.phase);
    checkGl(gl_, "render");
    stats_.uploadedBricks = resident_.atlas().uploadedBricks() - uploadedBefore;
    lit_ = lit;
    drawn_ = true;
  }

  Picture read(const ResolvedScene& scene) {
    if (!drawn_) throw InvalidArgument("render: nothing was drawn since the scene changed");
    resetGlState(gl_);
    Picture picture;
    const Stopwatch read;
    readLayers(gl_, held_.targets->picture, scene, 1, picture);
    RenderStats& stats = picture.stats = stats_;
    stats.readMs = read.elapsedMs();
    stats.bricks = volume_.bricks.size();
    stats.visibleBricks = held_.bricks->size();
    stats.brickSlots = held_.bricks->slots();
    if (options_.countFragments) stats.fragments = held_.targets->segments(gl_);
    addTextures(resident_.atlas(), stats);
    stats.bufferBytes = held_.targets->bytes() + pass_.bytes();
    if (lit_) light_.addTo(stats);
    return picture;
  }

 private:
  // Tells whether a brick holds all that segments read whose middles lie in it.
  bool withinApron(const IndexView& view, double segment) const {
    const glm::dvec3 reach = slabReach(view, segment);
    return std::max({reach.x, reach.y, reach.z}) <= volume_.layout.apron - 0.5 + 1e-6;
  }

  void checkPlanes(std::size_t planes) const {
    const std::size_t most = held_.transfer->freeUniforms(gl_);
    if (planes > most)
      throw InvalidArgument("clip.planes: " + std::to_string(planes) +
                            " planes in all are beyond the driver's limit of " + std::to_string(most) +
                            " beside this transfer function");
  }

  // What all runs of a picture share.
  struct Walk {
    double phase = 0.5;              // of the sample
    glm::ivec3 parts{1};             // of a brick
    std::optional<RayFrame> shared;  // coordinates of all runs; none: each has its own
    double done = 0;                 // share of the bricks that is drawn
  };

  // Draws all bricks, in as few runs as the atlas, the table of slots and the shader can do with.
  void drawRuns(const RayScene& rays, double phase) {
    const BrickSelection& bricks = *held_.bricks;
    if (bricks.size() == 0) return;
    Walk walk{phase, glm::ivec3(1), std::nullopt, 0};
    const glm::ivec3 interior = volume_.layout.interior;
    // As long as single precision is fine enough for all of the volume, all runs share their coordinates, so that a
    // segment at a face between two is in exactly one of them.
    constexpr std::int64_t kMostVoxels = 1 << 16;
    const CellBox all = cellsAround(bricks.origins(), interior);
    const glm::i64vec3 extent = all.count * glm::i64vec3(interior);
    if (std::max({extent.x, extent.y, extent.z}) <= kMostVoxels) walk.shared = frameOf(rays, all, phase);
    // Cells are parts of bricks, so that rays skip what is empty in a brick, as long as one table holds all of them.
    if (rays.scene.bricks.culling && SlotTable::fits(cellsAround(bricks.origins(), interior, parts_.count())))
      walk.parts = parts_.count();
    BrickRuns(rays.view, bricks.origins()).draw([&](std::span<const std::int32_t> positions) {
      return drawRun(rays, walk, positions);
    });
  }

  RayFrame frameOf(const RayScene& rays, const CellBox& cells, double phase) const {
    const SamplingOptions& sampling = rays.scene.sampling;
    return {rays.view, cells, volume_.layout.interior, sampling.spacing, sampling.segments, phase};
  }

  // Draws bricks in one go, or returns false where they are too many.
  bool drawRun(const RayScene& rays, Walk& walk, std::span<const std::int32_t> positions) {
    BrickSelection& bricks = *held_.bricks;
    std::vector<glm::ivec3> origins;
    for (const std::int32_t position : positions)
      origins.push_back(bricks.origins()[static_cast<std::size_t>(position)]);
    RayRun run;
    run.cells = {positions, cellsAround(origins, volume_.layout.interior, walk.parts), walk.parts, {}, version_, {}};
    if (!SlotTable::fits(run.cells.cells)) return false;
    if (!fits_ && positions.size() > std::max<std::size_t>(1, resident_.atlas().slots())) return false;
    const Stopwatch upload;
    bricks.require(positions);
    if (rays.light) light_.require(gl_, bricks, positions);
    run.cells.textures = SlotTable::texturesOf(bricks, positions);
    if (run.cells.textures.size() > static_cast<std::size_t>(kRayTextures)) return false;
    if (shown_.empty() || !(shownKey_ == std::pair(version_, origins))) {
      shown_ = shownParts(origins, walk.parts);
      shownKey_ = {version_, origins};
    }
    run.cells.shown = shown_;
    stats_.uploadMs += upload.elapsedMs();
    run.done = walk.done;
    run.share = static_cast<double>(positions.size()) / static_cast<double>(bricks.size());
    walk.done += run.share;
    const RayFrame frame =
        walk.shared ? *walk.shared : frameOf(rays, cellsAround(origins, volume_.layout.interior), walk.phase);
    if (frame.count == 0) return true;
    const Stopwatch sweep;
    pass_.draw(rays, frame, run);
    gl_.Finish();  // only a wait for the last ray tells the time
    stats_.sweepMs += sweep.elapsedMs();
    return true;
  }

  std::vector<std::uint8_t> shownParts(std::span<const glm::ivec3> origins, const glm::ivec3& parts) {
    if (parts == glm::ivec3(1)) return std::vector<std::uint8_t>(origins.size(), 1);
    parts_.read(origins);
    const std::size_t each = parts_.perBrick();
    std::vector<std::uint8_t> shown(origins.size() * each);
    for (std::size_t i = 0; i < origins.size(); ++i)
      parts_.show(origins[i], *held_.transfer, std::span(shown).subspan(i * each, each));
    return shown;
  }

  const GlFunctions& gl_;
  ResidentVolume& resident_;
  const Bricks& volume_;
  const RenderOptions options_;
  Held held_;
  bool background_ = false;  // is visible
  bool fits_ = false;        // all visible bricks are resident at once
  ResidentLight light_;
  BrickParts parts_;
  std::uint64_t version_ = 0;        // of what parts of bricks show
  std::vector<std::uint8_t> shown_;  // of the last run
  std::pair<std::uint64_t, std::vector<glm::ivec3>> shownKey_;
  RayPass pass_;
  bool drawn_ = false;  // nothing was thrown on the way, and the scene is the same
  bool lit_ = false;    // what was drawn reads the light
  RenderStats stats_;
};

RayCaster::RayCaster(ResidentVolume& volume, const ResolvedScene& scene, const RenderOptions& options)
    : implementation_(std::make_unique<Implementation>(volume, options)) {
  setScene(scene);
}
RayCaster::RayCaster(const GlContext& context, const Bricks& volume, const ResolvedScene& scene,
                     const RenderOptions& options, const AtlasLimits& limits)
    : own_(std::make_unique<ResidentVolume>(context, volume, atlasOptions(scene, volume, limits))),
      implementation_(std::make_unique<Implementation>(*own_, options)) {
  setScene(scene);
}
RayCaster::~RayCaster() = default;

void RayCaster::update(const ResolvedScene& next) { implementation_->update(next, hasScene() ? &scene() : nullptr); }
std::optional<RaySampling> RayCaster::sampling(const ResolvedScene& scene) const {
  return implementation_->sampling(scene);
}
void RayCaster::draw(const RenderSample& sample) { implementation_->draw(scene(), sample); }
Picture RayCaster::read() { return implementation_->read(scene()); }

}  // namespace umbrick
