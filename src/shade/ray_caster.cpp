// SPDX-License-Identifier: Apache-2.0
#include "umbrick/shade/ray_caster.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "shade/ray_pass.h"
#include "shade/value_caster.h"
#include "shade/view_planes.h"
#include "shade/visible_bricks.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/draw/hybrid_picture.h"
#include "umbrick/draw/mesh_picture.h"
#include "umbrick/draw/value_picture.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {

void checkScene(const ResolvedScene& scene, const ResidentVolume& resident) {
  if (!supports(Method::lightVolume, scene.model))
    throw InvalidArgument("model: " + modelName(scene.model) +
                          " is integrated by the reference alone; rays render emission, cone, ambient and lights");
  checkConeRays(scene);
  const Method method = occlusionMethod(scene).value_or(Method::lightVolume);
  if (method != Method::lightVolume && method != Method::coneRays)
    throw InvalidArgument("method: " + methodName(scene.method) +
                          " is one of slices; rays take light from a light volume");
  if (isShaded(scene)) checkShading(scene, resident.volume().layout.apron);
  checkOnGl(scene, resident);
}

// A depth of each pixel, as shaders read it.
class DepthTexture {
 public:
  void take(const GlFunctions& gl, const Image& depths) {
    const glm::ivec2 size(depths.width, depths.height);
    if (size_ != size) {
      texture_ = makeTexture2d(gl, GL_R32F, size.x, size.y, GL_NEAREST);
      size_ = size;
    }
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl.TextureSubImage2D(texture_.name(), 0, 0, 0, size.x, size.y, GL_RED, GL_FLOAT, depths.pixels.data());
  }
  const GlTexture& texture() const { return texture_; }

 private:
  GlTexture texture_;
  glm::ivec2 size_{0};
};

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
        codes_(resident),
        light_(resident, options.lightSweep),
        runs_(resident) {}

  /// Makes anew what another scene asks for or, when something throws, nothing.
  void update(const ResolvedScene& next) {
    requireMode(next, Technique::rays);
    checkMesh(next);
    resetGlState(gl_);
    if (showsValues(next.mode)) {
      if (!values_) values_.emplace(resident_, options_);
      values_->update(next);
    }
    if (traitsOf(next.mode).medium) {
      ResolvedScene medium = mediumOf(next);
      updateMedium(medium, medium_ ? &*medium_ : nullptr);
      medium_ = std::move(medium);
    }
    drawn_ = false;
  }

  void updateMedium(const ResolvedScene& next, const ResolvedScene* before) {
    checkScene(next, resident_);
    const bool lookup = !before || before->transfer != next.transfer || before->emitted != next.emitted ||
                        before->sampling.spacing != next.sampling.spacing ||
                        before->sampling.quadrature != next.sampling.quadrature;
    const bool selection =
        lookup || before->bricks.culling != next.bricks.culling || sharingOf(*before) != sharingOf(next);
    Held made;
    if (lookup) made.transfer.emplace(gl_, next.transfer, next.sampling, volume_, resident_.format(), next.emitted);
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
    const double edge = shortestVoxelEdge(volume_.indexToWorld);
    if (!traitsOf(scene.mode).medium) return RaySampling{edge / slicesPerVoxel(scene, volume_), edge};
    const double segment = scene.sampling.spacing / scene.sampling.segments;
    if (!withinApron(indexView(scene.camera, volume_.indexToWorld), segment)) return std::nullopt;
    return RaySampling{segment, edge};
  }

  void draw(const ResolvedScene& scene, const RenderSample& sample) {
    drawn_ = false;
    resetGlState(gl_);
    surfaces_.reset();
    mesh_.reset();
    if (scene.mesh.shape) mesh_ = drawMesh(scene, sample);
    if (mesh_) ends_.take(gl_, mesh_->depth);
    if (showsValues(scene.mode)) {
      values_->update(scene);  // changes something where another scene was refused for its medium alone
      values_->draw(scene, sample, mesh_ ? &ends_.texture() : nullptr);
    }
    if (scene.mode == Mode::hybrid) takeSurfaces(scene);
    if (traitsOf(scene.mode).medium) drawMedium(*medium_, sample);
    drawn_ = true;
  }

  Picture read(const ResolvedScene& scene) {
    if (!drawn_) throw InvalidArgument("render: nothing was drawn since the scene changed");
    resetGlState(gl_);
    if (!mesh_) return readVolume(scene, medium_);
    std::optional<ResolvedScene> medium = medium_;
    if (medium) medium->background.reset();
    Picture picture = readVolume(beforeMesh(scene), medium);
    layOverMesh(scene, *mesh_, picture);
    return picture;
  }

 private:
  // @param medium  see mediumOf(); none in modes without one
  Picture readVolume(const ResolvedScene& scene, const std::optional<ResolvedScene>& medium) {
    if (!traitsOf(scene.mode).medium) return values_->read(scene);
    Picture picture = readMedium(*medium);
    if (scene.mode == Mode::xray) {
      picture.visibility = picture.depth = picture.opacity = Image();
      showThrough(scene, picture);
    }
    if (scene.mode == Mode::hybrid) return composite(scene, *surfaces_, picture);
    return picture;
  }

  // Brings the surfaces to memory, and where the medium begins behind them to a texture.
  void takeSurfaces(const ResolvedScene& scene) {
    surfaces_ = values_->readFirst(scene);
    start_.take(gl_, surfaces_->start);
  }

  void drawMedium(const ResolvedScene& scene, const RenderSample& sample) {
    stats_ = {};
    const Stopwatch geometry;
    IndexView view = indexView(scene.camera, volume_.indexToWorld);
    if (!withinApron(view, scene.sampling.spacing / scene.sampling.segments))
      throw InvalidArgument("render: segments of rays reach beyond the apron of " +
                            std::to_string(volume_.layout.apron) + " voxels");
    view.seeThrough(sample.pixel);
    const std::vector<glm::dvec4> planes = viewPlanes(scene, volume_, background_);
    checkPlanes(planes.size());
    stats_.geometryMs = geometry.elapsedMs();
    const bool lit = occlusionMethod(scene) == Method::lightVolume;
    std::vector<LightDirection> coneLights;
    if (occlusionMethod(scene) == Method::coneRays) coneLights = lightsOf(scene, sample);
    stats_.directions = static_cast<int>(coneLights.size());
    light_.beginPicture();
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
                        coneLights,
                        surfaces_ ? &start_.texture() : nullptr,
                        mesh_ ? &ends_.texture() : nullptr,
                        codes_,
                        volume_,
                        *held_.targets,
                        options_.progress};
    pass_.begin(rays);
    const std::uint64_t uploadedBefore = resident_.atlas().uploadedBricks();
    runs_.draw(
        planOf(rays, sample.phase), [&](const RayFrame& frame, const RayRun& run) { drawRun(rays, frame, run); },
        stats_);
    checkGl(gl_, "render");
    stats_.uploadedBricks = resident_.atlas().uploadedBricks() - uploadedBefore;
    lit_ = lit;
  }

  Picture readMedium(const ResolvedScene& scene) {
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

  RayRunPlan planOf(const RayScene& rays, double phase) {
    RayRunPlan plan{rays.view, *held_.bricks};
    plan.fits = fits_;
    plan.spacing = rays.scene.sampling.spacing;
    plan.segments = rays.scene.sampling.segments;
    plan.phase = phase;
    plan.skips = rays.scene.bricks.culling;
    plan.version = version_;
    plan.isShown = [&](const Range& value, const Range& gradient, const Range& emission) {
      return held_.transfer->isVisible(value, gradient, emission);
    };
    if (!rays.coneLights.empty()) plan.together = "cone-rays";
    if (rays.light)
      plan.require = [&](std::span<const std::int32_t> positions) { light_.require(gl_, *held_.bricks, positions); };
    return plan;
  }

  void drawRun(const RayScene& rays, const RayFrame& frame, const RayRun& run) {
    if (resident_.context().software() && 2 * RayPass::stepsToLight(rays, frame) > RayPass::kMostTurns)
      throw InvalidArgument("occlusion.directions: " + std::to_string(rays.coneLights.size()) +
                            " cone-rays of a segment are more than software OpenGL takes through this volume");
    const Stopwatch sweep;
    pass_.draw(rays, frame, run);
    gl_.Finish();  // only a wait for the last ray tells the time
    stats_.sweepMs += sweep.elapsedMs();
  }

  const GlFunctions& gl_;
  ResidentVolume& resident_;
  const Bricks& volume_;
  const RenderOptions options_;
  Held held_;
  bool background_ = false;  // is visible
  bool fits_ = false;        // all visible bricks are resident at once
  const VoxelCodes codes_;
  ResidentLight light_;
  RayRuns runs_;
  std::uint64_t version_ = 0;              // of what parts of bricks show
  std::optional<ResolvedScene> medium_;    // whose medium is held; none: there was no such scene yet
  std::optional<ValueCaster> values_;      // of modes that look at values; none: there was no such scene yet
  std::optional<FirstSurfaces> surfaces_;  // of the mode hybrid; none: of another one
  DepthTexture start_;                     // where the medium begins behind them
  std::optional<MeshPicture> mesh_;        // none: the scene has no mesh
  DepthTexture ends_;                      // where rays end at it
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

void RayCaster::update(const ResolvedScene& next) { implementation_->update(next); }
std::optional<RaySampling> RayCaster::sampling(const ResolvedScene& scene) const {
  return implementation_->sampling(scene);
}
void RayCaster::draw(const RenderSample& sample) { implementation_->draw(scene(), sample); }
Picture RayCaster::read() { return implementation_->read(scene()); }

}  // namespace umbrick
