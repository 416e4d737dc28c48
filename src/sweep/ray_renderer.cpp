// SPDX-License-Identifier: Apache-2.0
#include "umbrick/sweep/ray_renderer.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/matrix.hpp>
#include <limits>
#include <thread>
#include <utility>

#include "sweep/cone_march.h"
#include "sweep/packet_march.h"
#include "sweep/swept_scene.h"
#include "sweep/value_rays.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/draw/hybrid_picture.h"
#include "umbrick/draw/mesh_picture.h"
#include "umbrick/draw/value_picture.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {

constexpr std::array<std::array<int, 3>, 3> kAxesByMain{{{1, 2, 0}, {0, 2, 1}, {0, 1, 2}}};  // u, v, n

PacketAxes axesAlong(std::size_t n, const SweptScene& scene, const glm::dvec3& low, const glm::dvec3& high) {
  PacketAxes axes;
  axes.u = kAxesByMain[n][0];
  axes.v = kAxesByMain[n][1];
  axes.n = kAxesByMain[n][2];
  const auto permuted = [&](const auto& p) { return glm::dvec3(p[axes.u], p[axes.v], p[axes.n]); };
  const IndexView& view = scene.view();
  axes.eye = permuted(view.eyeIndex);
  for (std::size_t i = 0; i < 3; ++i) axes.screen[i] = permuted(view.toIndex[i]);
  const glm::dmat4& toWorld = scene.volume().indexToWorld;
  const glm::dmat3 columns(glm::dvec3(toWorld[axes.u]), glm::dvec3(toWorld[axes.v]), glm::dvec3(toWorld[axes.n]));
  axes.metric = glm::transpose(columns) * columns;
  const auto depthOf = [&](int axis) { return view.axis[static_cast<std::size_t>(axis)].z; };
  axes.depth = {depthOf(axes.u), depthOf(axes.v), depthOf(axes.n), view.origin.z};
  for (const glm::dvec4& plane : scene.planes())
    axes.planes.emplace_back(plane[axes.u], plane[axes.v], plane[axes.n], plane.w);
  axes.low = permuted(low);
  axes.high = permuted(high);
  return axes;
}

// Returns the rows of pixels that may see a brick.
RowSpan rowsOf(const Brick& brick, const IndexView& view, const glm::ivec3& interior) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  bool behind = false, inFront = false;
  for (int corner = 0; corner < 8; ++corner) {
    glm::dvec3 at(brick.origin);
    for (int axis = 0; axis < 3; ++axis) at[axis] += corner >> axis & 1 ? interior[axis] : -1;
    const glm::dvec3 seen = view.toView(at);
    const bool perspective = view.projection == Projection::perspective;
    (seen.z > 0 || !perspective ? inFront : behind) = true;
    const double y = perspective ? seen.y / seen.z : seen.y;
    low = std::min(low, y);
    high = std::max(high, y);
  }
  if (!inFront) return {};
  if (behind) return {0, view.size.y - 1};
  const auto rowAt = [&](double y) {
    const double row = (y - view.centre.y + view.halfExtent.y) / (2 * view.halfExtent.y) * view.size.y;
    return static_cast<int>(std::floor(std::clamp(row, -2.0, view.size.y + 2.0)));
  };
  return {rowAt(low) - 1, rowAt(high) + 1};
}

}  // namespace

bool raysSupport(const SceneSettings& scene) {
  return supportsMode(scene, Technique::rays) &&
         (traitsOf(scene.mode).projection || sweptSupports(scene, Technique::rays));
}

int raySamplesPerVoxel(const ResolvedScene& scene, const Bricks& volume) {
  return static_cast<int>(std::clamp(std::round(segmentsPerVoxel(scene, volume)), 1.0, double(kMostPerVoxel)));
}

class RayRenderer::Implementation {
 public:
  Implementation(const Bricks& volume, const RenderOptions& options, std::optional<int> perVoxel)
      : options_(options), perVoxel_(perVoxel), scene_(volume, Technique::rays) {}

  void update(const ResolvedScene& next) {
    requireMode(next, Technique::rays);
    checkMesh(next);
    if (showsValues(next.mode)) {
      if (!values_) values_.emplace(scene_.volume(), options_);
      values_->update(next);
    }
    if (traitsOf(next.mode).medium) {
      const ResolvedScene medium = mediumOf(next);
      scene_.update(medium, medium_ ? &*medium_ : nullptr);
      medium_ = medium;
    }
    picture_.reset();
  }

  RaySampling sampling(const ResolvedScene& scene) const {
    const double edge = shortestVoxelEdge(scene_.volume().indexToWorld);
    return {edge / perVoxel_.value_or(raySamplesPerVoxel(scene, scene_.volume())), edge};
  }

  void draw(const ResolvedScene& scene, const RenderSample& sample) {
    picture_.reset();
    if (!scene.mesh.shape) {
      picture_ = drawVolume(scene, medium_, sample, nullptr);
      return;
    }
    const MeshPicture mesh = drawMesh(scene, sample);
    std::optional<ResolvedScene> medium = medium_;
    if (medium) medium->background.reset();
    Picture picture = drawVolume(beforeMesh(scene), medium, sample, &mesh.depth);
    layOverMesh(scene, mesh, picture);
    picture.stats.bufferBytes += (mesh.colour.pixels.size() + mesh.depth.pixels.size()) * sizeof(float);
    picture_ = std::move(picture);
  }

  // @param shown  see mediumOf(); none in modes without a medium
  // @param ends   depths at which rays end; null: nowhere
  Picture drawVolume(const ResolvedScene& scene, const std::optional<ResolvedScene>& shown, const RenderSample& sample,
                     const Image* ends) {
    if (!traitsOf(scene.mode).medium)
      return values_->draw(scene, sample, perVoxel_.value_or(raySamplesPerVoxel(scene, scene_.volume())), ends);
    const ResolvedScene& medium = *shown;
    const bool through = scene.mode == Mode::xray;
    Picture picture = emptyPicture(scene, options_.visibilityAndDepth && !through);
    std::optional<FirstSurfaces> surfaces;
    if (scene.mode == Mode::hybrid) {
      values_->update(scene);  // changes something where another scene was refused for its medium alone
      surfaces = values_->drawFirst(scene, sample, ends);
    }
    const Image* const starts = surfaces ? &surfaces->start : nullptr;
    scene_.prepare(medium, sample, picture.stats);
    const Stopwatch sweep;
    scene_.drawInBands(
        medium, medium.camera.height, kPacketEdge,
        [&](const Brick& brick) { return rowsOf(brick, scene_.view(), scene_.volume().layout.interior); },
        [&](int begin, int end) {
          if (occlusionMethod(medium) == Method::coneRays)
            marchCones(medium, ends, picture);
          else
            march(medium, frameOf(medium), starts, ends, begin, end, picture);
        },
        picture.stats);
    if (through) showThrough(scene, picture);
    picture.stats.sweepMs = sweep.elapsedMs();
    picture.stats.bufferBytes = picture.colour.pixels.size() * sizeof(float);
    return surfaces ? composite(scene, std::move(*surfaces), picture) : picture;
  }

  Picture read() const {
    if (!picture_) throw InvalidArgument("render: nothing was drawn since the scene changed");
    return *picture_;
  }

 private:
  void updateBricks() {
    if (bricks_ && generation_ == scene_.voxels().generation()) return;
    bricks_.emplace(scene_.voxels());
    generation_ = scene_.voxels().generation();
  }

  // Fills a picture whose light is found by rays of its own. @param ends  depths at which rays end; null: nowhere
  void marchCones(const ResolvedScene& scene, const Image* ends, Picture& picture) {
    if (scene_.isEmpty()) {
      for (std::size_t at = 0; at < picture.colour.pixels.size() / 4; ++at)
        scene_.storePixel(scene, at, glm::vec4(0), glm::vec2(0), picture);
      return;
    }
    updateBricks();
    ConeFrame frame;
    frame.voxels = &scene_.voxels();
    frame.bricks = &*bricks_;
    frame.table = &scene_.table();
    frame.directions = scene_.coneDirections();
    frame.planes = scene_.planes();
    frame.lightPlanes = scene_.lightPlanes();
    frame.visible = scene_.visibleBox();
    frame.mesh = scene.mesh.shape.get();
    for (std::vector<glm::dvec4>* planes : {&frame.planes, &frame.lightPlanes})
      for (const ClipPlane& plane : boxPlanes(frame.visible)) planes->push_back(plane);
    frame.longest = scene.sampling.spacing / scene.sampling.segments;
    frame.saturation = scene.sampling.saturation;
    const int width = scene.camera.width, height = scene.camera.height;
    const IndexView& view = scene_.view();
    tbb::enumerable_thread_specific<ConeMarch> marches([&] { return ConeMarch(frame); });
    std::atomic<int> done{0};
    const auto caller = std::this_thread::get_id();
    tbb::parallel_for(tbb::blocked_range<int>(0, height, 1), [&](const auto& range) {
      ConeMarch& march = marches.local();
      for (int y = range.begin(); y != range.end(); ++y)
        for (int x = 0; x < width; ++x) {
          const glm::dvec2 screen =
              view.centre + view.halfExtent * (2.0 * (glm::dvec2(x, y) + 0.5) / glm::dvec2(width, height) - 1.0);
          const ConeMarch::Pixel pixel =
              march.march(valueRay(view, screen),
                          ends ? static_cast<double>(*ends->at(x, y)) : std::numeric_limits<double>::infinity());
          const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
          scene_.storePixel(scene, at, glm::vec4(pixel.colour, pixel.opacity), glm::vec2(pixel.visibility, pixel.depth),
                            picture);
        }
      const int finished = done += static_cast<int>(range.size());
      if (options_.progress && std::this_thread::get_id() == caller)
        options_.progress(static_cast<double>(finished) / height);
    });
    for (const ConeMarch& march : marches) picture.stats.fragments += march.segments();
  }

  PacketFrame frameOf(const ResolvedScene& scene) {
    updateBricks();
    PacketFrame frame;
    static_cast<SweptFrame&>(frame) = scene_.frame(scene, options_.visibilityAndDepth);
    frame.bricks = &*bricks_;
    const Box visible = scene_.visibleBox();
    for (std::size_t n = 0; n < 3; ++n) frame.axes[n] = axesAlong(n, scene_, visible.min, visible.max);
    frame.perspective = scene.camera.projection == Projection::perspective;
    frame.perVoxel = perVoxel_.value_or(raySamplesPerVoxel(scene, scene_.volume()));
    return frame;
  }

  // Fills the rows of pixels begin <= y < end.
  // @param starts  depths from which rays see the medium; null: from the eye
  // @param ends    up to which they see it; null: all of it
  void march(const ResolvedScene& scene, const PacketFrame& frame, const Image* starts, const Image* ends, int begin,
             int end, Picture& picture) const {
    const int width = scene.camera.width, height = scene.camera.height;
    const int columns = (width + kPacketEdge - 1) / kPacketEdge, rows = (height + kPacketEdge - 1) / kPacketEdge;
    const IndexView& view = scene_.view();
    const bool nothing = scene_.isEmpty();
    tbb::enumerable_thread_specific<PacketMarch> marches([&] { return PacketMarch(frame); });
    const int firstRow = begin / kPacketEdge;
    std::atomic<int> done{firstRow};
    std::atomic<std::uint64_t> samples{0};
    const auto caller = std::this_thread::get_id();
    tbb::parallel_for(
        tbb::blocked_range<int>(firstRow, (end + kPacketEdge - 1) / kPacketEdge, 1), [&](const auto& range) {
          PacketMarch& march = marches.local();
          std::uint64_t taken = 0;
          for (int row = range.begin(); row != range.end(); ++row)
            for (int column = 0; column < columns; ++column) {
              std::array<glm::dvec2, kRayGroup> screen;
              PacketDepths depths;
              depths.end.fill(std::numeric_limits<double>::infinity());
              for (int i = 0; i < kRayGroup; ++i) {
                // What would lie outside of the picture goes with its last pixels.
                const int x = std::min(column * kPacketEdge + i % kPacketEdge, width - 1),
                          y = std::min(row * kPacketEdge + i / kPacketEdge, height - 1);
                const glm::dvec2 pixel(x + 0.5, y + 0.5);
                screen[static_cast<std::size_t>(i)] =
                    view.centre + view.halfExtent * (2.0 * pixel / glm::dvec2(width, height) - 1.0);
                if (starts) depths.start[static_cast<std::size_t>(i)] = static_cast<double>(*starts->at(x, y));
                if (ends) depths.end[static_cast<std::size_t>(i)] = static_cast<double>(*ends->at(x, y));
              }
              PacketPixels pixels{};
              if (!nothing) taken += march.march(screen, pixels, starts || ends ? &depths : nullptr);
              for (int i = 0; i < kRayGroup; ++i) {
                const int x = column * kPacketEdge + i % kPacketEdge, y = row * kPacketEdge + i / kPacketEdge;
                if (x >= width || y >= height) continue;
                const auto at =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
                scene_.storePixel(scene, at, pixels.colour[static_cast<std::size_t>(i)],
                                  pixels.aux[static_cast<std::size_t>(i)], picture,
                                  pixels.emitted[static_cast<std::size_t>(i)]);
              }
            }
          samples += taken;
          const int finished = done += static_cast<int>(range.size());
          if (options_.progress && std::this_thread::get_id() == caller)
            options_.progress(static_cast<double>(finished) / rows);
        });
    picture.stats.fragments += samples;
  }

  RenderOptions options_;
  std::optional<int> perVoxel_;
  SweptScene scene_;
  std::optional<ResolvedScene> medium_;  // of scene_; none: it has had none yet
  std::optional<BrickTable> bricks_;
  std::uint64_t generation_ = 0;  // of the bricks that it knows
  std::optional<ValueRays> values_;
  std::optional<Picture> picture_;  // none: nothing was drawn since the scene changed
};

RayRenderer::RayRenderer(const Bricks& volume, const ResolvedScene& scene, const RenderOptions& options,
                         std::optional<int> perVoxel)
    : implementation_(std::make_unique<Implementation>(volume, options, perVoxel)) {
  setScene(scene);
}

RayRenderer::~RayRenderer() = default;

void RayRenderer::update(const ResolvedScene& next) { implementation_->update(next); }

std::optional<RaySampling> RayRenderer::sampling(const ResolvedScene& scene) const {
  return implementation_->sampling(scene);
}

void RayRenderer::draw(const RenderSample& sample) { implementation_->draw(scene(), sample); }

Picture RayRenderer::read() { return implementation_->read(); }

}  // namespace umbrick
