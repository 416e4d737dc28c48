// SPDX-License-Identifier: Apache-2.0
#include "umbrick/shade/slice_renderer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <optional>
#include <string>

#include "shade/frame.h"
#include "shade/sweep_plan.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {
namespace {

// Half-spaces that keep the inside of a world box.
void appendBoxPlanes(std::vector<ClipPlane>& planes, const Box& box) {
  for (int axis = 0; axis < 3; ++axis) {
    ClipPlane low(0), high(0);
    low[axis] = 1;
    low.w = -box.min[axis];
    high[axis] = -1;
    high.w = box.max[axis];
    planes.push_back(low);
    planes.push_back(high);
  }
}

// Half-spaces that keep the inside of a box of index coordinates, in world units like all planes: their distances are
// those of the camera's.
void appendIndexBoxPlanes(std::vector<ClipPlane>& planes, const IndexBox& box, const glm::dmat4& indexToWorld) {
  const glm::dmat4 toIndex = glm::inverse(indexToWorld);
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec4 coordinate(toIndex[0][axis], toIndex[1][axis], toIndex[2][axis], toIndex[3][axis]);
    planes.push_back(coordinate - glm::dvec4(0, 0, 0, box.min[axis]));
    planes.push_back(glm::dvec4(0, 0, 0, box.max[axis]) - coordinate);
  }
}

std::vector<Brick> visibleBricks(const Bricks& volume, const TransferLookup& transfer, const BrickSettings& settings,
                                 bool backgroundVisible) {
  std::vector<Brick> bricks;
  for (const Brick& brick : volume.bricks)
    if (!settings.culling || transfer.isVisible(brick.value, brick.gradient)) bricks.push_back(brick);
  if (backgroundVisible) {
    const std::vector<Brick> background = backgroundBricks(volume);
    bricks.insert(bricks.end(), background.begin(), background.end());
  }
  return bricks;
}

std::vector<glm::ivec3> originsOf(const std::vector<Brick>& bricks) {
  std::vector<glm::ivec3> origins;
  for (const Brick& brick : bricks) origins.push_back(brick.origin);
  return origins;
}

}  // namespace

class SliceRenderer::Implementation {
 public:
  Implementation(const GlContext& context, const Bricks& volume, const ResolvedScene& scene,
                 const RenderOptions& options)
      : gl_(context.gl()), volume_(volume), scene_(scene), options_(options) {
    checkScene(context);
    const SamplingOptions& sampling = scene.sampling;
    const VoxelFormat format = parseVoxelFormat(scene.bricks.format, volume);
    transfer_.emplace(gl_, scene.transfer, sampling, volume, format);
    const Range background{volume.background, volume.background};
    backgroundVisible_ = !volume.domain.empty() && transfer_->isVisible(background, {0, 0});
    std::vector<Brick> bricks = visibleBricks(volume, *transfer_, scene.bricks, backgroundVisible_);
    origins_ = originsOf(bricks);
    AtlasOptions atlas;
    atlas.format = format;
    atlas.budgetBytes = options.budgetBytes > 0 ? options.budgetBytes : scene.bricks.budgetMiB << 20;
    atlas.maxTextureBytes = options.maxTextureBytes;
    atlas.maxTextureEdge = options.maxTextureEdge;
    atlas_.emplace(context, volume, std::move(bricks), atlas);
    TargetOptions targets;
    targets.width = scene.camera.width;
    targets.height = scene.camera.height;
    targets.eyeBits = sampling.bits;
    const std::optional<Method> method = occlusionMethod(scene);
    const bool dos = method == Method::dos;
    targets.occlusionBits = dos ? scene.occlusion.bits : 0;
    targets.aux = options.visibilityAndDepth;
    targets_.emplace(gl_, targets);
    polygons_.emplace(gl_);
    pass_ = !method ? makeEmissionPass() : dos ? makeOcclusionPass() : makeOrdinatesPass();
  }

  const ResolvedScene& scene() const { return scene_; }

  Picture render(const Camera& camera, const RenderSample& sample) {
    if (camera.width != scene_.camera.width || camera.height != scene_.camera.height)
      throw InvalidArgument("render: the renderer was made for pictures of another size");
    Picture picture;
    RenderStats& stats = picture.stats;
    Stopwatch geometry;
    prepareFrame(camera, sample);
    Frame& frame = *frame_;
    const std::uint64_t uploadedBefore = atlas_->uploadedBricks();
    stats.geometryMs = geometry.elapsedMs();

    targets_->clear(gl_);
    gl_.Viewport(0, 0, camera.width, camera.height);
    pass_->begin(frame, runs_);
    for (const SweepRun& run : runs_) {
      const Stopwatch upload;
      makeResident(run);
      pass_->fill(frame, run.first, run.last);
      stats.uploadMs += upload.elapsedMs();
      const Stopwatch sweep;
      frame.clock.start();
      pass_->draw(frame, run.first, run.last);
      frame.clock.lap(&PassTimes::eyeMs);
      // Only what waits for the last fragment tells the time of the sweep.
      gl_.Finish();
      stats.sweepMs += sweep.elapsedMs();
    }
    checkGl(gl_, "render");

    const Stopwatch read;
    readPicture(frame, picture);
    stats.readMs = read.elapsedMs();
    stats.slices = frame.slices.count();
    stats.bricks = volume_.bricks.size();
    stats.visibleBricks = origins_.size();
    stats.polygons = frame.slices.polygons.size();
    stats.fragments = frame.fragments.total();
    stats.uploadedBricks = atlas_->uploadedBricks() - uploadedBefore;
    stats.textureBytes = atlas_->textureBytes();
    stats.textures = atlas_->textureCount();
    const glm::ivec3 textureSize = atlas_->textureSize();
    stats.textureEdge = std::max({textureSize.x, textureSize.y, textureSize.z});
    stats.bufferBytes = targets_->bytes();
    stats.passes = frame.clock.times();
    pass_->addTo(stats);
    stats.formatError = atlas_->formatError();
    return picture;
  }

  Image probe(std::int64_t slice) {
    if (!frame_ || slice < 0 || slice >= frame_->slices.count())
      throw InvalidArgument("probe: no slice " + std::to_string(slice) + " in the last picture");
    Frame& frame = *frame_;
    const int width = frame.camera.width, height = frame.camera.height;
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
    makeResident({slice, slice + 1, needed});
    polygons_->fill(frame.slices, slice, slice + 1, frame.view, *atlas_, options_.reverseBricks);
    polygons_->bind();
    for (const SliceDraw& draw : polygons_->draws()) {
      bindVolume(frame, draw.texture);
      polygons_->draw(draw.firstIndex, draw.indices);
    }
    const Image read = readTexture(gl_, target, width, height);
    checkGl(gl_, "probe");
    Image image(width, height, 2);
    const TexelScale scale = atlas_->valueScale();
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
  void checkScene(const GlContext& context) const {
    if (!supports(Method::ordinates, scene_.model))
      throw InvalidArgument("model: " + modelName(scene_.model) +
                            " is integrated by the reference alone; slices render emission, cone and lights");
    if (!supports(scene_.method, scene_.model))
      throw InvalidArgument("method: " + methodName(scene_.method) + " knows one cone around the view axis; " +
                            modelName(scene_.model) + " need ordinates");
    const int most = context.maxTextureEdge2d();
    if (scene_.camera.width > most || scene_.camera.height > most)
      throw InvalidArgument("size: " + std::to_string(scene_.camera.width) + " x " +
                            std::to_string(scene_.camera.height) + " is beyond the driver's limit of " +
                            std::to_string(most) + " pixels along an edge");
    if (scene_.transfer.is2d() && !volume_.hasGradients)
      throw InvalidArgument("render: a 2D transfer function needs bricks with gradients");
  }

  void checkReach(const IndexView& view) const {
    const glm::dvec3 reach = slabReach(view, scene_.sampling.spacing);
    if (std::max({reach.x, reach.y, reach.z}) > volume_.layout.apron - 0.5 + 1e-6)
      throw InvalidArgument("render: slabs reach beyond the apron of " + std::to_string(volume_.layout.apron) +
                            " voxels");
  }

  std::vector<glm::dvec4> viewPlanes(const Camera& camera) const {
    std::vector<ClipPlane> planes = scene_.clipPlanes;
    if (scene_.clipBox) appendBoxPlanes(planes, *scene_.clipBox);
    if (backgroundVisible_)
      appendIndexBoxPlanes(planes, mediumBox(scene_.transfer, volume_.domain), volume_.indexToWorld);
    for (ClipPlane& plane : planes) plane = planeInView(plane, camera);
    if (camera.nearDistance > 0) planes.emplace_back(0, 0, 1, -camera.nearDistance);
    return planes;
  }

  // The box of the medium cuts no slab where the background is invisible, but nothing lies beyond it.
  std::vector<glm::dvec4> viewBounds(const Camera& camera, std::vector<glm::dvec4> planes) const {
    if (backgroundVisible_ || volume_.domain.empty()) return planes;
    std::vector<ClipPlane> box;
    appendIndexBoxPlanes(box, mediumBox(scene_.transfer, volume_.domain), volume_.indexToWorld);
    for (const ClipPlane& plane : box) planes.push_back(planeInView(plane, camera));
    return planes;
  }

  // The longest of the four, of a crooked volume.
  double domainDiagonal() const {
    const glm::dvec3 extent(volume_.domain.extent());
    double longest = 0;
    for (unsigned c = 0; c < 4; ++c)
      longest = std::max(longest, glm::length(glm::dmat3(volume_.indexToWorld) *
                                              (extent * glm::dvec3(1, c & 1 ? -1 : 1, c & 2 ? -1 : 1))));
    return longest;
  }

  void prepareFrame(const Camera& camera, const RenderSample& sample) {
    const IndexView view = indexView(camera, volume_.indexToWorld);
    checkReach(view);
    std::vector<glm::dvec4> planes = viewPlanes(camera);
    std::vector<glm::dvec4> bounds = viewBounds(camera, planes);
    const double spacing = scene_.sampling.spacing;
    ProxySlices slices = cutSlices(view, origins_, volume_.layout.interior, bounds, spacing);
    // The first slab of another phase begins before or behind the eye: there must be nothing.
    if (sample.phase != 0.5 && slices.first > 0)
      slices = cutSlices(view, origins_, volume_.layout.interior, bounds, spacing, sample.phase);
    frame_.emplace(Frame{gl_, scene_, camera, view, std::move(planes), std::move(bounds), std::move(slices), *atlas_,
                         *transfer_, *targets_, *polygons_, FragmentCounter(gl_, options_.countFragments),
                         options_.reverseBricks, shortestVoxelEdge(volume_.indexToWorld), domainDiagonal(),
                         PassClock(gl_, options_.timePasses), sample});
    pass_->plan(*frame_);
    std::vector<const ProxySlices*> sweeps{&frame_->slices};
    if (pass_->occluders()) sweeps.push_back(pass_->occluders());
    runs_ = planSweep(sweeps, origins_.size(),
                      atlas_->holdsAll() ? std::numeric_limits<std::size_t>::max() : atlas_->slots());
  }

  void makeResident(const SweepRun& run) {
    if (!atlas_->holdsAll()) {
      std::vector<bool> needed(origins_.size(), false);
      for (const std::int32_t brick : run.bricks) needed[static_cast<std::size_t>(brick)] = true;
      for (std::size_t brick = 0; brick < needed.size(); ++brick)
        if (!needed[brick]) atlas_->release(static_cast<std::int32_t>(brick));
    }
    atlas_->require(run.bricks);
  }

  void readPicture(const Frame& frame, Picture& picture) const {
    const int width = frame.camera.width, height = frame.camera.height;
    picture.colour = readTexture(gl_, targets_->eye, width, height);
    const glm::vec3 ambient(scene_.ambient);
    const auto brightest = static_cast<float>(pass_->brightest());
    for (std::size_t i = 0; i < picture.colour.pixels.size(); i += 4) {
      float* pixel = &picture.colour.pixels[i];
      pixel[3] = std::min(pixel[3], 1.0f);  // but for roundings it is
      const float through = 1 - pixel[3];
      for (int c = 0; c < 3; ++c) {
        pixel[c] *= brightest * ambient[c];
        if (scene_.background) pixel[c] += through * static_cast<float>((*scene_.background)[c]);
      }
      if (scene_.background) pixel[3] = 1;
    }
    if (!options_.visibilityAndDepth) return;
    const Image aux = readTexture(gl_, targets_->aux, width, height);
    picture.visibility = Image(width, height, 1);
    picture.depth = Image(width, height, 1);
    for (std::size_t i = 0; i < picture.depth.pixels.size(); ++i) {
      const float* pixel = &aux.pixels[4 * i];
      picture.visibility.pixels[i] = pixel[0];
      picture.depth.pixels[i] = pixel[3] > 0 ? pixel[1] / pixel[3] : std::numeric_limits<float>::infinity();
    }
  }

  const GlFunctions& gl_;
  const Bricks& volume_;
  const ResolvedScene scene_;
  const RenderOptions options_;
  bool backgroundVisible_ = false;
  std::vector<glm::ivec3> origins_;  // of the visible bricks
  std::optional<TransferLookup> transfer_;
  std::optional<BrickAtlas> atlas_;
  std::optional<RenderTargets> targets_;
  std::optional<PolygonBuffer> polygons_;
  std::unique_ptr<SlicePass> pass_;
  SpecialisedProgram probe_{"shade/slice.vert", "shade/probe.frag"};
  std::vector<SweepRun> runs_;
  std::optional<Frame> frame_;  // of the last picture
};

SliceRenderer::SliceRenderer(const GlContext& context, const Bricks& volume, const ResolvedScene& scene,
                             const RenderOptions& options)
    : implementation_(std::make_unique<Implementation>(context, volume, scene, options)) {}
SliceRenderer::~SliceRenderer() = default;

Picture SliceRenderer::render() { return render(implementation_->scene().camera); }
Picture SliceRenderer::render(const Camera& camera, const RenderSample& sample) {
  return implementation_->render(camera, sample);
}
Image SliceRenderer::probe(std::int64_t slice) { return implementation_->probe(slice); }
std::vector<double> SliceRenderer::sliceDepths() const { return implementation_->sliceDepths(); }

}  // namespace umbrick
