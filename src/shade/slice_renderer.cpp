// SPDX-License-Identifier: Apache-2.0
#include "umbrick/shade/slice_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <optional>
#include <string>

#include "shade/frame.h"
#include "shade/sweep_plan.h"
#include "shade/view_planes.h"
#include "shade/visible_bricks.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {
namespace {

// The parts of the renderer that must be made anew after a change of the scene. Camera, clip planes, lights, theta and
// the like ask for nothing: they are looked at when a picture is drawn.
struct Dirty {
  bool lookup = true;     // the transfer function as shaders read it
  bool selection = true;  // which bricks are visible
  bool targets = true;    // buffers of the picture
  bool pass = true;       // how light is computed

  Dirty() = default;
  Dirty(const ResolvedScene& before, const ResolvedScene& after)
      : lookup(before.transfer != after.transfer || before.emitted != after.emitted ||
               before.sampling.spacing != after.sampling.spacing ||
               before.sampling.quadrature != after.sampling.quadrature),
        selection(lookup || before.bricks.culling != after.bricks.culling || sharingOf(before) != sharingOf(after)),
        targets(targetsOf(before) != targetsOf(after)),
        pass(occlusionMethod(before) != occlusionMethod(after)) {}

 private:
  static std::array<int, 4> targetsOf(const ResolvedScene& scene) {
    return {scene.camera.width, scene.camera.height, scene.sampling.bits, occlusionBits(scene)};
  }

 public:
  /// Returns the bits of dos's occlusion buffers; 0 where there are none.
  static int occlusionBits(const ResolvedScene& scene) {
    return occlusionMethod(scene) == Method::dos ? scene.occlusion.bits : 0;
  }
};

// Returns the scene as it is drawn: where no values between slices of voxels are looked up, a slab is what its slice
// is.
ResolvedScene asDrawn(ResolvedScene scene) {
  if (scene.technique == Technique::stacks && scene.sampling.stackInterpolation == StackInterpolation::none) {
    scene.sampling.quadrature = Quadrature::midpoint;
    scene.sampling.segments = 1;
  }
  return scene;
}

std::unique_ptr<SlicePass> makePass(const ResolvedScene& scene, ResidentVolume& volume, LightSweep sweep) {
  const std::optional<Method> method = occlusionMethod(scene);
  if (!method) return makeEmissionPass();
  if (*method == Method::lightVolume) return makeLightVolumePass(volume, sweep);
  return *method == Method::dos ? makeOcclusionPass() : makeOrdinatesPass();
}

}  // namespace

class SliceRenderer::Implementation {
 public:
  Implementation(ResidentVolume& resident, const RenderOptions& options)
      : gl_(resident.context().gl()), resident_(resident), volume_(resident.volume()), options_(options) {
    polygons_.emplace(gl_);
  }

  /// Makes anew all that is dirty or, when something throws, nothing.
  /// @param next  as it is drawn
  void update(ResolvedScene next) {
    const Dirty dirty = scene_ ? Dirty(*scene_, next) : Dirty();
    requireMode(next, next.technique == Technique::stacks ? Technique::stacks : Technique::slices);
    checkScene(next);
    resetGlState(gl_);
    std::optional<TransferLookup> lookup;
    if (dirty.lookup) lookup.emplace(gl_, next.transfer, next.sampling, volume_, resident_.format(), next.emitted);
    const TransferLookup& transfer = lookup ? *lookup : *transfer_;
    bool backgroundVisible = backgroundVisible_;
    std::optional<BrickSelection> selection;
    bool fits = fits_;
    if (dirty.selection) {
      backgroundVisible = showsBackground(transfer, volume_);
      selection.emplace(resident_.atlas(), visibleBricks(resident_, transfer, next.bricks.culling, backgroundVisible),
                        sharingOf(next));
      fits = selection->reserve();
    }
    std::optional<RenderTargets> targets;
    if (dirty.targets) {
      TargetOptions options;
      options.width = next.camera.width;
      options.height = next.camera.height;
      options.eyeBits = next.sampling.bits;
      options.occlusionBits = Dirty::occlusionBits(next);
      options.aux = options_.visibilityAndDepth;
      targets.emplace(gl_, options);
    }
    std::unique_ptr<SlicePass> pass = dirty.pass ? makePass(next, resident_, options_.lightSweep) : nullptr;
    frame_.reset();  // it refers to what is replaced
    if (lookup) transfer_.emplace(std::move(*lookup));
    if (selection) selection_.emplace(std::move(*selection));
    if (targets) targets_.emplace(std::move(*targets));
    if (pass) pass_ = std::move(pass);
    backgroundVisible_ = backgroundVisible;
    fits_ = fits;
    scene_ = std::move(next);
  }

  std::optional<RaySampling> sampling(const ResolvedScene& scene) const {
    try {
      if (requiredApron(scene, volume_.indexToWorld) > volume_.layout.apron) return std::nullopt;
    } catch (const InvalidArgument&) {
      return std::nullopt;
    }
    RaySampling sampling{scene.sampling.spacing, shortestVoxelEdge(volume_.indexToWorld)};
    const std::optional<Method> method = occlusionMethod(scene);
    if (!method) return sampling;
    sampling.mostOrder = 1;
    const double scale = *method == Method::ordinates ? scene.occlusion.ordinates.scale : 0;
    const double texelVoxels = scale > 0 ? 1 / scale : 1;
    sampling.leastOrder = 1 - 0.55 * std::clamp(0.5 * std::log2(2 * texelVoxels), 0.0, 1.0);
    return sampling;
  }

  /// Draws a picture. What throws leaves none to be read.
  void draw(const RenderSample& sample) {
    const ResolvedScene& scene = *scene_;
    drawn_ = false;
    stats_ = {};
    resetGlState(gl_);
    const std::uint64_t uploadedBefore = resident_.atlas().uploadedBricks();
    targets_->clear(gl_);
    gl_.Viewport(0, 0, scene.camera.width, scene.camera.height);
    const std::vector<std::optional<StackAim>> sweeps = sweepsOf(scene, sample);
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
      const Stopwatch geometry;
      prepareFrame(scene, sample, sweeps[i]);
      frame_->first = i == 0;
      frame_->progress.begin(frame_->slices.count(), frame_->size(),
                             static_cast<double>(i) / static_cast<double>(sweeps.size()),
                             1 / static_cast<double>(sweeps.size()));
      stats_.geometryMs += geometry.elapsedMs();
      drawFrame(*frame_);
    }
    checkGl(gl_, "render");
    stats_.uploadedBricks = resident_.atlas().uploadedBricks() - uploadedBefore;
    drawn_ = true;
  }

  /// Cuts the slices of a picture that is not drawn.
  void cut() {
    const ResolvedScene& scene = *scene_;
    drawn_ = false;
    stats_ = {};
    resetGlState(gl_);
    prepareFrame(scene, {}, sweepsOf(scene, {}).front());
    frame_->progress.begin(frame_->slices.count(), frame_->size());
  }

  Picture read() {
    const ResolvedScene& scene = *scene_;
    if (!frame_ || !drawn_) throw InvalidArgument("render: nothing was drawn since the scene changed");
    resetGlState(gl_);
    Picture picture;
    const Stopwatch read;
    readLayers(gl_, *targets_, scene, pass_->brightest(), picture);
    RenderStats& stats = picture.stats = stats_;
    stats.readMs = read.elapsedMs();
    stats.bricks = volume_.bricks.size();
    stats.visibleBricks = selection_->size();
    stats.brickSlots = selection_->slots();
    addTextures(resident_.atlas(), stats);
    stats.bufferBytes = targets_->bytes();
    pass_->addTo(stats);
    return picture;
  }

  Image probe(std::int64_t slice) {
    if (!frame_ || slice < 0 || slice >= frame_->slices.count())
      throw InvalidArgument("probe: no slice " + std::to_string(slice) + " in the last picture");
    Frame& frame = *frame_;
    const int width = frame.camera.width, height = frame.camera.height;
    resetGlState(gl_);
    const GlTexture target = makeTexture2d(gl_, GL_RGBA32F, width, height, GL_NEAREST);
    const GlFramebuffer framebuffer = makeFramebuffer(gl_, {target.name()});
    const glm::vec4 zero(0);
    gl_.Disable(GL_SCISSOR_TEST);
    gl_.ColorMaski(0, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl_.ClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, 0, &zero.x);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    gl_.Viewport(0, 0, width, height);
    gl_.Disable(GL_DEPTH_TEST);
    gl_.Disable(GL_STENCIL_TEST);
    gl_.Enablei(GL_BLEND, 0);
    gl_.BlendFunci(0, GL_ONE, GL_ONE);
    GlProgram& program = probe_.get(gl_, slabConstants(frame));
    setSlabUniforms(program, frame);
    program.use();
    const auto begin = static_cast<std::size_t>(frame.slices.start[static_cast<std::size_t>(slice)]);
    const auto end = static_cast<std::size_t>(frame.slices.start[static_cast<std::size_t>(slice) + 1]);
    std::vector<std::int32_t> needed;
    for (std::size_t p = begin; p < end; ++p) needed.push_back(frame.slices.polygons[p].brick);
    selection_->require(needed);
    polygons_->fill(frame.slices, slice, slice + 1, frame.view, *selection_, options_.reverseBricks);
    polygons_->bind();
    for (const SliceDraw& draw : polygons_->draws()) {
      bindVolume(frame, draw.texture);
      polygons_->draw(draw.firstIndex, draw.indices);
    }
    const Image read = readTexture(gl_, target, width, height);
    checkGl(gl_, "probe");
    Image image(width, height, 2);
    const TexelScale scale = resident_.atlas().valueScale();
    for (std::size_t i = 0; i < read.pixels.size() / 4; ++i) {
      image.pixels[2 * i] = static_cast<float>(read.pixels[4 * i] * scale.scale + scale.offset);
      image.pixels[2 * i + 1] = read.pixels[4 * i + 1];
    }
    return image;
  }

  std::vector<double> sliceDepths() const {
    std::vector<double> depths;
    if (frame_)
      for (std::int64_t i = 0; i < frame_->slices.count(); ++i) depths.push_back(frame_->slices.depth(i));
    return depths;
  }

 private:
  void checkScene(const ResolvedScene& scene) const {
    const std::optional<Method> method = occlusionMethod(scene);
    refuseConeRays(scene, scene.technique == Technique::stacks ? "stacks" : "slices");
    if (scene.technique == Technique::stacks && method && *method != Method::lightVolume)
      throw InvalidArgument("method: " + methodName(*method) +
                            " takes light from slice to slice across the view; stacks read a light volume");
    if (!supports(Method::lightVolume, scene.model))
      throw InvalidArgument("model: " + modelName(scene.model) +
                            " is integrated by the reference alone; slices render emission, cone, ambient and lights");
    if (!supports(scene.method, scene.model) && traitsOf(scene.model).sphere)
      throw InvalidArgument("method: " + methodName(scene.method) + " knows light from the viewer's side; " +
                            modelName(scene.model) + " needs a light volume");
    if (!supports(scene.method, scene.model))
      throw InvalidArgument("method: " + methodName(scene.method) + " knows one cone around the view axis; " +
                            modelName(scene.model) + " need ordinates or a light volume");
    checkOnGl(scene, resident_);
  }

  void checkReach(const IndexView& view, const ResolvedScene& scene) const {
    const glm::dvec3 reach = slabReach(view, scene.sampling.spacing);
    if (std::max({reach.x, reach.y, reach.z}) > volume_.layout.apron - 0.5 + 1e-6)
      throw InvalidArgument("render: slabs reach beyond the apron of " + std::to_string(volume_.layout.apron) +
                            " voxels");
  }

  // Planes are uniforms of the shaders. Those of the clip box, of the near distance and of the medium count, too.
  void checkPlanes(std::size_t planes) const {
    const std::size_t most = transfer_->freeUniforms(gl_);
    if (planes > most)
      throw InvalidArgument("clip.planes: " + std::to_string(planes) +
                            " planes in all are beyond the driver's limit of " + std::to_string(most) +
                            " beside this transfer function");
  }

  // Returns the stacks that a picture is made of, one after another; none for slices across the view.
  std::vector<std::optional<StackAim>> sweepsOf(const ResolvedScene& scene, const RenderSample& sample) const {
    if (scene.technique != Technique::stacks) return {std::nullopt};
    IndexView view = indexView(scene.camera, volume_.indexToWorld);
    view.seeThrough(sample.pixel);
    const bool between = scene.sampling.stackInterpolation == StackInterpolation::linear;
    const std::vector<StackAim> stacks = aimStacks(view, between ? scene.sampling.spacing : 0, sample.phase);
    return {stacks.begin(), stacks.end()};
  }

  // Draws the slices of a frame that is prepared.
  void drawFrame(Frame& frame) {
    pass_->begin(frame, runs_);
    for (const SweepRun& run : runs_) {
      const Stopwatch upload;
      selection_->require(run.bricks);
      pass_->fill(frame, run.first, run.last);
      stats_.uploadMs += upload.elapsedMs();
      const Stopwatch sweep;
      frame.clock.start();
      pass_->draw(frame, run.first, run.last);
      frame.clock.lap(&PassTimes::eyeMs);
      // Only a wait for the last fragment tells the time of the sweep.
      gl_.Finish();
      stats_.sweepMs += sweep.elapsedMs();
    }
    stats_.slices += frame.slices.count();
    stats_.polygons += frame.slices.polygons.size();
    stats_.fragments += frame.fragments.total();
    const PassTimes& times = frame.clock.times();
    stats_.passes.extinctionMs += times.extinctionMs;
    stats_.passes.windowsMs += times.windowsMs;
    stats_.passes.eyeMs += times.eyeMs;
  }

  // Tells whether slabs of a stack, which are not cut at the eye, reach behind it.
  bool reachesEye(const IndexView& view, const StackAim& aim, const ProxySlices& slices) const {
    if (view.projection == Projection::perspective) return aim.phase != 0.5 && slices.first == 0;
    for (unsigned c = 0; c < 8; ++c) {
      const glm::dvec3 low(volume_.domain.min), size(volume_.domain.extent());
      if (view.toView(low + size * glm::dvec3(c & 1, c >> 1 & 1, c >> 2 & 1) - 0.5).z < 0) return true;
    }
    return false;
  }

  void prepareFrame(const ResolvedScene& scene, const RenderSample& sample, std::optional<StackAim> stack) {
    const Camera& camera = scene.camera;
    IndexView view = indexView(camera, volume_.indexToWorld);
    checkReach(view, scene);  // rays through other places in the pixels lie between those at the edges of the image
    view.seeThrough(sample.pixel);
    std::vector<glm::dvec4> planes = viewPlanes(scene, volume_, backgroundVisible_);
    std::vector<glm::dvec4> bounds = viewBounds(scene, volume_, backgroundVisible_, planes);
    ProxySlices slices;
    if (stack) {
      const auto cut = [&] { return cutStack(view, *stack, selection_->origins(), volume_.layout.interior, bounds); };
      slices = cut();
      const bool between = scene.sampling.stackInterpolation == StackInterpolation::linear;
      if (between && slices.first == 0 && stack->phase != 0.5) {
        stack->phase = 0.5;
        slices = cut();
      }
      if (reachesEye(view, *stack, slices)) planes.emplace_back(0, 0, 1, 0);
    } else {
      const double spacing = scene.sampling.spacing;
      slices = cutSlices(view, selection_->origins(), volume_.layout.interior, bounds, spacing);
      // With another phase the first slab begins in front of or behind the eye, so nothing may be there.
      if (sample.phase != 0.5 && slices.first > 0)
        slices = cutSlices(view, selection_->origins(), volume_.layout.interior, bounds, spacing, sample.phase);
    }
    checkPlanes(planes.size());
    frame_.emplace(Frame{gl_,
                         scene,
                         camera,
                         view,
                         std::move(planes),
                         std::move(bounds),
                         std::move(slices),
                         *selection_,
                         selection_->atlas(),
                         *transfer_,
                         *targets_,
                         *polygons_,
                         FragmentCounter(gl_, options_.countFragments),
                         options_.reverseBricks,
                         shortestVoxelEdge(volume_.indexToWorld),
                         domainDiagonal(volume_),
                         PassClock(gl_, options_.timePasses),
                         sample,
                         stack,
                         true,
                         SweepProgress(gl_, options_.progress)});
    pass_->plan(*frame_);
    std::vector<const ProxySlices*> sweeps{&frame_->slices};
    if (pass_->occluders()) sweeps.push_back(pass_->occluders());
    runs_ = planSweep(sweeps, selection_->size(),
                      fits_ ? std::numeric_limits<std::size_t>::max() : resident_.atlas().slots());
  }

  const GlFunctions& gl_;
  ResidentVolume& resident_;
  const Bricks& volume_;
  const RenderOptions options_;
  std::optional<ResolvedScene> scene_;  // as it is drawn
  bool backgroundVisible_ = false;
  bool fits_ = false;  // all visible bricks are resident at once
  std::optional<TransferLookup> transfer_;
  std::optional<BrickSelection> selection_;  // the visible bricks
  std::optional<RenderTargets> targets_;
  std::optional<PolygonBuffer> polygons_;
  std::unique_ptr<SlicePass> pass_;
  SpecialisedProgram probe_{"shade/slice.vert", "shade/probe.frag"};
  std::vector<SweepRun> runs_;
  std::optional<Frame> frame_;  // the frame of the last picture
  bool drawn_ = false;          // nothing was thrown on the way
  RenderStats stats_;           // statistics of drawing that frame
};

SliceRenderer::SliceRenderer(ResidentVolume& volume, const ResolvedScene& scene, const RenderOptions& options)
    : implementation_(std::make_unique<Implementation>(volume, options)) {
  setScene(scene);
}
SliceRenderer::SliceRenderer(const GlContext& context, const Bricks& volume, const ResolvedScene& scene,
                             const RenderOptions& options, const AtlasLimits& limits)
    : own_(std::make_unique<ResidentVolume>(context, volume, atlasOptions(scene, volume, limits))),
      implementation_(std::make_unique<Implementation>(*own_, options)) {
  setScene(scene);
}
SliceRenderer::~SliceRenderer() = default;

void SliceRenderer::update(const ResolvedScene& next) { implementation_->update(asDrawn(next)); }
Picture SliceRenderer::render(const Camera& camera, const RenderSample& sample) {
  setCamera(camera);
  return render(sample);
}
std::optional<RaySampling> SliceRenderer::sampling(const ResolvedScene& scene) const {
  return implementation_->sampling(scene);
}
void SliceRenderer::draw(const RenderSample& sample) { implementation_->draw(sample); }
Picture SliceRenderer::read() { return implementation_->read(); }
void SliceRenderer::cut() { implementation_->cut(); }
Image SliceRenderer::probe(std::int64_t slice) { return implementation_->probe(slice); }
std::vector<double> SliceRenderer::sliceDepths() const { return implementation_->sliceDepths(); }

}  // namespace umbrick
