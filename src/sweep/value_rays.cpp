// SPDX-License-Identifier: Apache-2.0
#include "sweep/value_rays.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

#include "sweep/index_planes.h"
#include "sweep/packet_kernels.h"
#include "sweep/surface_rays.h"
#include "sweep/surface_shader.h"
#include "sweep/swept_scene.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/draw/value_picture.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {

// Rays along a face of the box count as in it, whatever rounding makes of them.
constexpr double kFaceMargin = 1e-6;

ProjectionKind kindOf(Mode mode) {
  return mode == Mode::mip     ? ProjectionKind::largest
         : mode == Mode::minip ? ProjectionKind::smallest
                               : ProjectionKind::sum;
}

std::vector<double> valuesOf(const ResolvedScene& scene) {
  std::vector<double> values;
  for (const SceneSurface& surface : scene.surfaces) values.push_back(surface.value);
  return values;
}

// Adds a volume's box, grown by a margin, to half-spaces.
std::vector<glm::dvec4> within(const IndexBox& box, double margin, std::vector<glm::dvec4> planes) {
  for (const ClipPlane& plane : boxPlanes({glm::dvec3(box.min) - margin, glm::dvec3(box.max) + margin}))
    planes.push_back(plane);
  return planes;
}

// Where rays lie on the screen.
glm::dvec2 screenOf(const IndexView& view, int x, int y) {
  return view.centre + view.halfExtent * (2.0 * (glm::dvec2(x, y) + 0.5) / glm::dvec2(view.size) - 1.0);
}

}  // namespace

ValueRays::ValueRays(const Bricks& volume, const RenderOptions& options) : options_(options), voxels_(volume, false) {}

void ValueRays::update(const ResolvedScene& next) {
  const bool surfaces = traitsOf(next.mode).surfaces;
  if (surfaces) {
    checkSurfaces(next, voxels_.volume().value, voxels_.volume().layout.apron);
    SurfaceShader(next, voxels_.volume().indexToWorld);  // says whether there is light
    checkSurfaceLight(next);
    if (occlusionMethod(next) && next.transfer.is2d()) requireGradients(voxels_.volume(), next.gradients);
  }
  const std::vector<double> values = surfaces ? valuesOf(next) : std::vector<double>();
  if (selected_ && all_ == !surfaces && values_ == values && budgetMiB_ == next.bricks.budgetMiB &&
      culling_ == next.bricks.culling)
    return;
  const Stopwatch watch;
  const float background = voxels_.volume().background;
  const auto isWanted = [&](const Range& range) {
    if (!next.bricks.culling) return true;
    if (!surfaces) return range.min != background || range.max != background;
    return std::ranges::any_of(values, [&](double value) { return range.min <= value && range.max > value; });
  };
  voxels_.select(isWanted, next.bricks.budgetMiB << 20);
  table_.emplace(voxels_);
  selected_ = true;
  all_ = !surfaces;
  values_ = values;
  budgetMiB_ = next.bricks.budgetMiB;
  culling_ = next.bricks.culling;
  loadMs_ += watch.elapsedMs();
  loaded_ += voxels_.loaded();
}

// Begins a picture: where its rays go, and what is known of it before they do.
Picture ValueRays::begin(const ResolvedScene& scene, const RenderSample& sample) {
  const bool surfaces = traitsOf(scene.mode).surfaces;
  Picture picture = emptyPicture(scene, options_.visibilityAndDepth && surfaces);
  RenderStats& stats = picture.stats;
  stats.uploadMs = std::exchange(loadMs_, 0);
  stats.uploadedBricks = std::exchange(loaded_, 0);
  stats.bricks = voxels_.volume().bricks.size();
  stats.visibleBricks = stats.brickSlots = voxels_.bricks().size();
  stats.textureBytes = voxels_.bytes();
  view_ = indexView(scene.camera, voxels_.volume().indexToWorld);
  view_.seeThrough(sample.pixel);
  planes_ = indexPlanes(scene, voxels_.volume(), false);
  stats.bufferBytes = picture.colour.pixels.size() * sizeof(float);
  if (surfaces && occlusionMethod(scene)) {
    if (!light_) light_.emplace(voxels_.volume());
    light_->update(scene, sample, voxels_, stats);
  }
  return picture;
}

Picture ValueRays::draw(const ResolvedScene& scene, const RenderSample& sample, int perVoxel, const Image* ends) {
  Picture picture = begin(scene, sample);
  const Stopwatch sweep;
  if (traitsOf(scene.mode).surfaces)
    drawSurfaces(scene, ends, picture, nullptr);
  else
    drawProjection(scene, perVoxel, ends, picture);
  picture.stats.sweepMs = sweep.elapsedMs();
  return picture;
}

FirstSurfaces ValueRays::drawFirst(const ResolvedScene& scene, const RenderSample& sample, const Image* ends) {
  ResolvedScene surfaces = scene;
  surfaces.background.reset();
  FirstSurfaces first{begin(surfaces, sample), Image(scene.camera.width, scene.camera.height, 1)};
  const Stopwatch sweep;
  drawSurfaces(surfaces, ends, first.picture, &first.start);
  first.picture.stats.sweepMs = sweep.elapsedMs();
  first.picture.stats.bufferBytes += first.start.pixels.size() * sizeof(float);
  return first;
}

// Draws rows on all cores and tells how many are done.
void ValueRays::eachRow(int rows, const std::function<void(int)>& draw) const {
  std::atomic<int> done{0};
  const auto caller = std::this_thread::get_id();
  tbb::parallel_for(tbb::blocked_range<int>(0, rows, 1), [&](const auto& range) {
    for (int row = range.begin(); row != range.end(); ++row) draw(row);
    const int finished = done += static_cast<int>(range.size());
    if (options_.progress && std::this_thread::get_id() == caller)
      options_.progress(static_cast<double>(finished) / rows);
  });
}

void ValueRays::drawProjection(const ResolvedScene& scene, int perVoxel, const Image* ends, Picture& picture) {
  const Bricks& volume = voxels_.volume();
  const int width = scene.camera.width, height = scene.camera.height;
  Image values(width, height, 1);
  // The box of voxel centres: the volume's domain has one more voxel of background around it.
  ProjectionFrame frame{&voxels_, &*table_, {}, kindOf(scene.mode), perVoxel, scene.bricks.culling};
  if (!volume.domain.empty()) frame.box = {volume.domain.min + 1, volume.domain.max - 1};
  const std::vector<glm::dvec4> planes = within(frame.box, kFaceMargin, planes_);
  tbb::enumerable_thread_specific<ProjectionMarch> marches([&] { return ProjectionMarch(frame); });
  eachRow((height + kPacketEdge - 1) / kPacketEdge, [&](int row) {
    ProjectionMarch& march = marches.local();
    for (int left = 0; left < width; left += kPacketEdge) {
      ProjectionMarch::Rays rays;
      for (int i = 0; i < kRayGroup; ++i) {
        // What would lie outside of the picture goes with its last pixels.
        const int x = std::min(left + i % kPacketEdge, width - 1),
                  y = std::min(row * kPacketEdge + i / kPacketEdge, height - 1);
        ValueRay& ray = rays[static_cast<std::size_t>(i)] = valueRay(view_, screenOf(view_, x, y));
        if (frame.box.empty())
          ray.leave = -1;
        else
          ray.clip(planes);
        if (ends) ray.leave = std::min(ray.leave, static_cast<double>(*ends->at(x, y)));
      }
      ProjectionMarch::Values projected;
      march.march(rays, projected);
      for (int i = 0; i < kRayGroup; ++i) {
        const int x = left + i % kPacketEdge, y = row * kPacketEdge + i / kPacketEdge;
        if (x >= width || y >= height) continue;
        const float value = projected[static_cast<std::size_t>(i)];
        *values.at(x, y) = value;
        storeProjected(scene, value, volume.background, picture.colour.at(x, y));
      }
    }
  });
  for (const ProjectionMarch& march : marches) picture.stats.fragments += march.samples();
  picture.layers.push_back({"value", std::move(values), true});
}

void ValueRays::drawSurfaces(const ResolvedScene& scene, const Image* ends, Picture& picture, Image* start) {
  const Bricks& volume = voxels_.volume();
  const int width = scene.camera.width, height = scene.camera.height;
  std::optional<SurfaceLayers> layers;
  if (options_.visibilityAndDepth) layers.emplace(width, height);
  const SurfaceLight* const light = occlusionMethod(scene) ? &*light_ : nullptr;
  const glm::dvec3 whole = light ? light->whole() : glm::dvec3(1);
  const double power = whole.r + whole.g + whole.b;
  const SurfaceShader shader(scene, volume.indexToWorld, whole);
  const CameraFrame camera = cameraFrame(scene.camera);
  const std::vector<glm::dvec4> planes = within(volume.domain, 0, planes_);
  const double full = 1 - scene.sampling.saturation;
  tbb::enumerable_thread_specific<SurfaceRays> tracers(
      [&] { return SurfaceRays(voxels_, *table_, volume.domain, scene.surfaces, scene.gradients); });
  eachRow(height, [&](int y) {
    SurfaceRays& tracer = tracers.local();
    for (int x = 0; x < width; ++x) {
      const glm::dvec2 screen = screenOf(view_, x, y);
      ValueRay ray = valueRay(view_, screen);
      ray.clip(planes);
      if (ends) ray.leave = std::min(ray.leave, static_cast<double>(*ends->at(x, y)));
      const WorldRay world = worldRay(scene.camera, camera, screen);
      glm::dvec4 pixel(0);
      double depth = 0, visibility = 0, behind = std::numeric_limits<double>::infinity();
      const auto visit = [&](const SurfaceHit& hit) {
        const glm::dvec3 normal = shader.normalOf(hit.gradient, world.viewer);
        const glm::dvec3 arriving = light ? light->shareAt(*hit.brick, hit.at, normal) : glm::dvec3(1);
        const double share = (1 - pixel.w) * scene.surfaces[hit.surface].opacity;
        if (layers && pixel.w == 0 && (share > 0 || start))
          layers->keep(x, y, scene.surfaces[hit.surface].value, world.from + hit.t * world.along, normal);
        pixel += share * glm::dvec4(shader.shade(hit.surface, normal, world.viewer, arriving), 1);
        visibility += share * (light && power > 0 ? glm::dot(arriving, whole) / power : 1);
        depth += share * hit.t;
        behind = startBehind(scene, hit.t, pixel.w);
        return !start && pixel.w < full;
      };
      if (!ray.empty()) tracer.trace(ray, visit);
      storeOver(scene, pixel, picture.colour.at(x, y));
      if (start) *start->at(x, y) = static_cast<float>(behind);
      if (!layers) continue;
      const auto opacity = static_cast<float>(pixel.w);
      *picture.opacity.at(x, y) = opacity;
      *picture.visibility.at(x, y) = static_cast<float>(visibility);
      *picture.depth.at(x, y) =
          opacity > 0 ? static_cast<float>(depth / pixel.w) : std::numeric_limits<float>::infinity();
    }
  });
  for (const SurfaceRays& tracer : tracers) picture.stats.fragments += tracer.cells();
  if (layers) layers->moveTo(picture);
}

}  // namespace umbrick
