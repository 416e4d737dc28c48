// SPDX-License-Identifier: Apache-2.0
#include "umbrick/sweep/shear_warp_renderer.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

#include "sweep/row_march.h"
#include "sweep/swept_scene.h"
#include "umbrick/core/error.h"
#include "umbrick/core/memory.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {

// Returns slices along n, front to back, a share of a voxel apart; the first one is at the eye where that is inside.
std::vector<double> slicesOf(const RayLattice& lattice, const BrickRows& rows, int perVoxel) {
  std::vector<double> slices;
  if (rows.low().z >= rows.high().z) return slices;
  // Cells before the first owned voxel belong to a brick, too.
  double first = lattice.sign > 0 ? rows.low().z - 1 : rows.high().z;
  const double last = lattice.sign > 0 ? rows.high().z : rows.low().z - 1;
  if (lattice.perspective && (lattice.eye.z - first) * lattice.sign > 0) {
    first = lattice.eye.z;
    slices.push_back(first);
  }
  const double step = lattice.sign / static_cast<double>(perVoxel);
  for (auto i = static_cast<std::int64_t>(std::ceil(first / step - 1e-9));; ++i) {
    const double at = static_cast<double>(i) * step;
    if ((at - last) * lattice.sign > 1e-9) break;
    if (slices.empty() || std::abs(at - slices.back()) > 1e-9) slices.push_back(at);
  }
  return slices;
}

// Returns the rows of a lattice that may meet a brick.
RowSpan rowsOf(const Brick& brick, const RayLattice& lattice, const glm::ivec3& interior) {
  const double lowV = brick.origin[lattice.v] - 1.0, highV = brick.origin[lattice.v] + double(interior[lattice.v]);
  double front = brick.origin[lattice.n] - 1.0, back = brick.origin[lattice.n] + double(interior[lattice.n]);
  if (lattice.sign < 0) std::swap(front, back);
  if (lattice.perspective) {
    if ((back - lattice.eye.z) * lattice.sign <= 0) return {};
    if ((front - lattice.eye.z) * lattice.sign < 0) front = lattice.eye.z;
  }
  // Rows are straight across the slices, so that they meet most at the first or at the last.
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double n : {front, back}) {
    const double spacing = lattice.spacing(n).y, start = lattice.start(n).y;
    if (spacing < 1e-6) return {0, lattice.height - 1};
    low = std::min(low, (lowV - start) / spacing);
    high = std::max(high, (highV - start) / spacing);
  }
  const auto bounded = [&](double row) {
    return static_cast<int>(std::floor(std::clamp(row, -2.0, lattice.height + 2.0)));
  };
  return {bounded(low) - 1, bounded(high) + 1};
}

}  // namespace

bool shearWarpSupports(const SceneSettings& scene) {
  return supportsMode(scene, Technique::shearWarp) && sweptSupports(scene, Technique::shearWarp);
}

ShearWarpSampling shearWarpSampling(const ResolvedScene& scene, const Bricks& volume) {
  const double perVoxel = segmentsPerVoxel(scene, volume);
  ShearWarpSampling sampling;
  sampling.slicesPerVoxel = static_cast<int>(std::clamp(std::round(perVoxel), 1.0, double(kMostPerVoxel)));
  sampling.raysPerVoxel = std::clamp(perVoxel, 0.25, double(kMostPerVoxel));
  sampling.raysPerPixel = std::min(0.75, 0.5 * perVoxel);
  return sampling;
}

class ShearWarpRenderer::Implementation {
 public:
  Implementation(const Bricks& volume, const RenderOptions& options, std::optional<ShearWarpSampling> sampling)
      : options_(options), sampling_(sampling), scene_(volume, Technique::shearWarp) {}

  void update(const ResolvedScene& next, const ResolvedScene* before) {
    requireMode(next, Technique::shearWarp);
    scene_.update(next, before);
    drawn_ = false;
  }

  // Rays that are more than a voxel apart are left out: slices are never.
  RaySampling sampling(const ResolvedScene& scene) const {
    const double edge = shortestVoxelEdge(scene_.volume().indexToWorld);
    const ShearWarpSampling taken = sampling_.value_or(shearWarpSampling(scene, scene_.volume()));
    return {edge / std::max(1.0, taken.raysPerVoxel), edge};
  }

  void draw(const ResolvedScene& scene, const RenderSample& sample) {
    pictures_.clear();
    drawn_ = false;
    stats_ = {};
    scene_.prepare(scene, sample, stats_);
    const Stopwatch sweep;
    if (!scene_.isEmpty()) drawLattices(scene);
    stats_.sweepMs = sweep.elapsedMs();
    drawn_ = true;
  }

  Picture read(const ResolvedScene& scene) {
    if (!drawn_) throw InvalidArgument("render: nothing was drawn since the scene changed");
    const Stopwatch watch;
    Picture picture = emptyPicture(scene, options_.visibilityAndDepth);
    const auto width = static_cast<std::size_t>(scene.camera.width);
    tbb::parallel_for(tbb::blocked_range<int>(0, scene.camera.height, 8), [&](const auto& rows) {
      std::vector<WarpedPixel> pixels(width);
      for (int y = rows.begin(); y != rows.end(); ++y) {
        std::ranges::fill(pixels, WarpedPixel());
        for (const LatticePicture& part : pictures_) warpRow(part, scene_.view(), y, pictures_.size() > 1, pixels);
        for (std::size_t x = 0; x < width; ++x)
          scene_.storePixel(scene, static_cast<std::size_t>(y) * width + x, pixels[x].colour, pixels[x].aux, picture);
      }
    });
    picture.stats = stats_;
    picture.stats.readMs = watch.elapsedMs();
    return picture;
  }

 private:
  void drawLattices(const ResolvedScene& scene) {
    const Bricks& volume = scene_.volume();
    const bool aux = options_.visibilityAndDepth;
    const Box visible = scene_.visibleBox();
    const ShearWarpSampling sampling = sampling_.value_or(shearWarpSampling(scene, volume));
    LatticeOptions options;
    options.raysPerVoxel = sampling.raysPerVoxel;
    options.raysPerPixel = sampling.raysPerPixel;
    const Box domain{glm::dvec3(volume.domain.min), glm::dvec3(volume.domain.max)};
    const std::vector<RayLattice> lattices =
        rayLattices(scene_.view(), glm::dmat3(volume.indexToWorld), domain, visible.min, visible.max, options);
    double done = 0;
    for (const RayLattice& lattice : lattices) {
      LatticePicture picture;
      picture.lattice = lattice;
      picture.stride = lattice.width;
      const auto rays = static_cast<std::size_t>(lattice.width) * static_cast<std::size_t>(lattice.height);
      requireMemory("shear-warp: " + std::to_string(lattice.width) + " x " + std::to_string(lattice.height) + " rays",
                    static_cast<double>(rays) * (sizeof(glm::vec4) + (aux ? sizeof(glm::vec2) : 0)));
      picture.colour.assign(rays, glm::vec4(0));
      picture.filled.assign(static_cast<std::size_t>(lattice.height), 0);
      if (aux) picture.aux.assign(rays, glm::vec2(0));
      stats_.bufferBytes += rays * sizeof(glm::vec4);
      std::size_t slices = 0;
      scene_.drawInBands(
          scene, lattice.height, 1, [&](const Brick& brick) { return rowsOf(brick, lattice, volume.layout.interior); },
          [&](int begin, int end) {
            const BrickRows rows(scene_.voxels(), lattice);
            const MarchFrame frame = frameOf(scene, lattice, rows, sampling);
            slices = std::max(slices, frame.slices.size());
            if (frame.slices.size() > 1)
              march(frame, begin, end, picture, done, 1.0 / static_cast<double>(lattices.size()));
          },
          stats_);
      stats_.slices += static_cast<std::int64_t>(slices);
      pictures_.push_back(std::move(picture));
      done += 1.0 / static_cast<double>(lattices.size());
    }
  }

  MarchFrame frameOf(const ResolvedScene& scene, const RayLattice& lattice, const BrickRows& rows,
                     const ShearWarpSampling& sampling) const {
    MarchFrame frame;
    static_cast<SweptFrame&>(frame) = scene_.frame(scene, options_.visibilityAndDepth);
    frame.lattice = &lattice;
    frame.rows = &rows;
    for (const double at : slicesOf(lattice, rows, sampling.slicesPerVoxel))
      frame.slices.push_back({at, lattice.start(at), lattice.spacing(at)});
    for (const glm::dvec4& plane : scene_.planes())
      frame.planes.emplace_back(plane[lattice.u], plane[lattice.v], plane[lattice.n], plane.w);
    return frame;
  }

  // Fills the rows begin <= j < end of a lattice, which is so large a share of the picture.
  void march(const MarchFrame& frame, int begin, int end, LatticePicture& picture, double done, double share) {
    tbb::enumerable_thread_specific<RowMarch> marches([&] { return RowMarch(frame); });
    std::atomic<int> rows{begin};
    std::atomic<std::uint64_t> samples{0};
    const auto caller = std::this_thread::get_id();
    tbb::parallel_for(tbb::blocked_range<int>(begin, end, 2), [&](const auto& range) {
      RowMarch& march = marches.local();
      std::uint64_t taken = 0;
      for (int j = range.begin(); j != range.end(); ++j) taken += march.march(j, picture);
      samples += taken;
      const int finished = rows += static_cast<int>(range.size());
      if (options_.progress && std::this_thread::get_id() == caller)
        options_.progress(done + share * finished / picture.lattice.height);
    });
    stats_.fragments += samples;
  }

  RenderOptions options_;
  std::optional<ShearWarpSampling> sampling_;
  SweptScene scene_;
  bool drawn_ = false;
  std::vector<LatticePicture> pictures_;
  RenderStats stats_;
};

ShearWarpRenderer::ShearWarpRenderer(const Bricks& volume, const ResolvedScene& scene, const RenderOptions& options,
                                     std::optional<ShearWarpSampling> sampling)
    : implementation_(std::make_unique<Implementation>(volume, options, sampling)) {
  setScene(scene);
}

ShearWarpRenderer::~ShearWarpRenderer() = default;

void ShearWarpRenderer::update(const ResolvedScene& next) {
  implementation_->update(next, hasScene() ? &scene() : nullptr);
}

std::optional<RaySampling> ShearWarpRenderer::sampling(const ResolvedScene& scene) const {
  return implementation_->sampling(scene);
}

void ShearWarpRenderer::draw(const RenderSample& sample) { implementation_->draw(scene(), sample); }

Picture ShearWarpRenderer::read() { return implementation_->read(scene()); }

}  // namespace umbrick
