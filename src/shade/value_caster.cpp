// SPDX-License-Identifier: Apache-2.0
#include "shade/value_caster.h"

#include <algorithm>
#include <cmath>

#include "shade/view_planes.h"
#include "shade/visible_bricks.h"
#include "umbrick/core/error.h"
#include "umbrick/draw/value_picture.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/scene/shading_lights.h"

namespace umbrick {
namespace {

void checkPlanes(const GlFunctions& gl, std::size_t planes) {
  constexpr GLint kValueUniforms = 256;
  GLint vectors = 0;
  gl.GetIntegerv(GL_MAX_FRAGMENT_UNIFORM_VECTORS, &vectors);
  const auto most = static_cast<std::size_t>(std::max(vectors - kValueUniforms, 0));
  if (planes > most)
    throw InvalidArgument("clip.planes: " + std::to_string(planes) +
                          " planes in all are beyond the driver's limit of " + std::to_string(most));
}

}  // namespace

int slicesPerVoxel(const ResolvedScene& scene, const Bricks& volume) {
  constexpr double kMost = 8;
  const double segments = shortestVoxelEdge(volume.indexToWorld) * scene.sampling.segments / scene.sampling.spacing;
  return static_cast<int>(std::clamp(std::round(segments), 1.0, kMost));
}

ValueCaster::ValueCaster(ResidentVolume& resident, const RenderOptions& options)
    : resident_(resident), options_(options), codes_(resident), light_(resident, options.lightSweep), runs_(resident) {}

bool ValueCaster::isWanted(const Wanted& wanted, float background, const Range& range) {
  if (!wanted.culling) return true;
  if (!wanted.surfaces) return range.min != background || range.max != background;
  return std::ranges::any_of(wanted.values, [&](double value) { return range.min <= value && range.max > value; });
}

void ValueCaster::update(const ResolvedScene& next) {
  checkSize(next, resident_.context());
  Wanted wanted;
  wanted.surfaces = traitsOf(next.mode).surfaces;
  wanted.culling = next.bricks.culling;
  if (wanted.surfaces) {
    checkSurfaces(next, resident_.volume().value, resident_.volume().layout.apron);
    if (isShaded(next)) shadingLights(next);  // says whether there is light
    checkSurfaceLight(next);
    if (occlusionMethod(next) && next.transfer.is2d()) requireGradients(resident_.volume(), next.gradients);
    wanted.lit = occlusionMethod(next).has_value();
    for (const SceneSurface& surface : next.surfaces) wanted.values.push_back(surface.value);
  }
  if (wanted_ == wanted) return;
  const std::vector<Brick>& all = resident_.volume().bricks;
  std::vector<std::int32_t> numbers;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (isWanted(wanted, resident_.volume().background, all[i].value)) numbers.push_back(static_cast<std::int32_t>(i));
  BrickSelection selection(resident_.atlas(), std::move(numbers),
                           wanted.lit ? SlotSharing::apart : SlotSharing::shared);
  fits_ = selection.reserve();
  bricks_ = std::move(selection);
  wanted_ = std::move(wanted);
  ++version_;
}

void ValueCaster::draw(const ResolvedScene& scene, const RenderSample& sample, const GlTexture* ends) {
  stats_ = {};
  const Bricks& volume = resident_.volume();
  const GlFunctions& gl = resident_.context().gl();
  const Stopwatch geometry;
  view_ = indexView(scene.camera, volume.indexToWorld);
  view_.seeThrough(sample.pixel);
  const std::vector<glm::dvec4> planes = viewPlanes(scene, volume, false);
  checkPlanes(gl, planes.size());
  stats_.geometryMs = geometry.elapsedMs();
  if (wanted_->lit) light(scene, sample);
  const ValueScene rays{
      gl, scene, view_, planes, volume, *bricks_, codes_, options_.progress, wanted_->lit ? &light_ : nullptr, ends};
  const bool surfaces = wanted_->surfaces;
  if (surfaces)
    surfaces_.begin(rays, options_.visibilityAndDepth || scene.mode == Mode::hybrid);
  else
    projection_.begin(rays, slicesPerVoxel(scene, volume));
  const std::uint64_t uploadedBefore = resident_.atlas().uploadedBricks();
  const auto draw = [&](const RayFrame& frame, const RayRun& run) {
    if (surfaces)
      surfaces_.draw(rays, frame, run, stats_);
    else
      projection_.draw(rays, frame, run, stats_);
  };
  runs_.draw(planOf(scene), draw, stats_);
  checkGl(gl, "render");
  stats_.uploadedBricks = resident_.atlas().uploadedBricks() - uploadedBefore;
}

void ValueCaster::light(const ResolvedScene& scene, const RenderSample& sample) {
  const Bricks& volume = resident_.volume();
  light_.beginPicture();
  light_.updateSurfaces(scene, sample, view_, viewPlanes(scene, volume, showsBackground(scene.transfer, volume)));
}

RayRunPlan ValueCaster::planOf(const ResolvedScene& scene) {
  const Bricks& volume = resident_.volume();
  RayRunPlan plan{view_, *bricks_};
  plan.fits = fits_;
  plan.spacing = shortestVoxelEdge(volume.indexToWorld);
  plan.corner = kBetweenVoxels;
  plan.skips = scene.bricks.culling;
  plan.joins = false;
  // Bounds depend on the mode, and all else on what the bricks were selected for.
  const bool smallest = scene.mode == Mode::minip;
  plan.version = 2 * version_ + static_cast<std::uint64_t>(smallest);
  plan.isShown = [this](const Range& value, const Range&, const Range&) {
    return isWanted(*wanted_, resident_.volume().background, value);
  };
  if (wanted_->lit)
    plan.require = [this](std::span<const std::int32_t> positions) {
      light_.require(resident_.context().gl(), *bricks_, positions);
    };
  if (!wanted_->surfaces)
    plan.bound = [this, smallest](const Range& value) {
      const double code = codes_.toCode(smallest ? value.min : value.max);
      return static_cast<float>((smallest ? -code : code) + codes_.rounding());
    };
  return plan;
}

Picture ValueCaster::read(const ResolvedScene& scene) {
  Picture picture;
  const Stopwatch read;
  picture.stats = stats_;
  if (wanted_->surfaces)
    surfaces_.show(resident_.context().gl(), scene, view_, options_.countFragments, picture);
  else
    projection_.show(scene, picture);
  picture.stats.readMs += read.elapsedMs();
  picture.stats.bricks = resident_.volume().bricks.size();
  picture.stats.visibleBricks = bricks_->size();
  picture.stats.brickSlots = bricks_->slots();
  if (!options_.countFragments) picture.stats.fragments = 0;
  addTextures(resident_.atlas(), picture.stats);
  if (wanted_->lit) light_.addTo(picture.stats);
  picture.stats.bufferBytes = wanted_->surfaces ? surfaces_.bytes() : projection_.bytes();
  return picture;
}

FirstSurfaces ValueCaster::readFirst(const ResolvedScene& scene) {
  ResolvedScene surfaces = scene;
  surfaces.background.reset();
  FirstSurfaces first{read(surfaces), {}};
  first.start = surfaces_.start(resident_.context().gl(), scene);
  if (options_.visibilityAndDepth) return first;
  first.picture.visibility = first.picture.depth = first.picture.opacity = Image();
  first.picture.layers.clear();
  return first;
}

}  // namespace umbrick
