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

#include "sweep/brick_light.h"
#include "sweep/index_planes.h"
#include "sweep/row_march.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {

constexpr int kMostSlicesPerVoxel = 8;

void checkScene(const ResolvedScene& scene, const Bricks& volume) {
  if (!supports(Method::lightVolume, scene.model))
    throw InvalidArgument("model: " + modelName(scene.model) +
                          " is integrated by the reference alone; shear-warp renders emission, cone and lights");
  if (!shearWarpSupports(scene))
    throw InvalidArgument("method: " + methodName(scene.method) +
                          " is one of slices; shear-warp takes light from a light volume");
  if (scene.transfer.is2d() && !volume.hasGradients)
    throw InvalidArgument("render: a 2D transfer function needs bricks with gradients");
}

double voxelEdge(const Bricks& volume) { return shortestVoxelEdge(volume.indexToWorld); }

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

}  // namespace

bool shearWarpSupports(const SceneSettings& scene) {
  return supports(Method::lightVolume, scene.model) &&
         occlusionMethod(scene).value_or(Method::lightVolume) == Method::lightVolume;
}

std::string cpuInstructions() { return rowInstructions(); }

ShearWarpSampling shearWarpSampling(const ResolvedScene& scene, const Bricks& volume) {
  const double perVoxel = voxelEdge(volume) * scene.sampling.segments / scene.sampling.spacing;
  ShearWarpSampling sampling;
  sampling.slicesPerVoxel = static_cast<int>(std::clamp(std::round(perVoxel), 1.0, double(kMostSlicesPerVoxel)));
  sampling.raysPerVoxel = std::clamp(perVoxel, 0.25, double(kMostSlicesPerVoxel));
  sampling.raysPerPixel = std::min(0.75, 0.5 * perVoxel);
  return sampling;
}

class ShearWarpRenderer::Implementation {
 public:
  Implementation(const Bricks& volume, const RenderOptions& options, std::optional<ShearWarpSampling> sampling)
      : volume_(volume), options_(options), sampling_(sampling), voxels_(volume), light_(volume) {}

  void update(const ResolvedScene& next, const ResolvedScene* before) {
    checkScene(next, volume_);
    const bool transfer = !before || before->transfer != next.transfer;
    std::optional<MediumTable> table;
    if (transfer) {
      // What this extinction leaves of light on the way through a thousandth of a voxel is nothing.
      table.emplace(next.transfer, volume_.background, 1e5 / voxelEdge(volume_));
    }
    if (transfer || before->bricks.culling != next.bricks.culling) {
      const MediumTable& now = table ? *table : *table_;
      const Range background{volume_.background, volume_.background};
      backgroundVisible_ = !volume_.domain.empty() && !now.isTransparent(background, {0, 0});
      const Stopwatch watch;
      voxels_.select(now, next.bricks.culling, backgroundVisible_, next.bricks.budgetMiB << 20);
      loadMs_ = watch.elapsedMs();
      loaded_ = voxels_.loaded();
    }
    if (table) table_.emplace(std::move(*table));
    pictures_.clear();
  }

  void draw(const ResolvedScene& scene, const RenderSample& sample) {
    pictures_.clear();
    stats_ = {};
    stats_.uploadMs = loadMs_;
    stats_.uploadedBricks = loaded_;
    loadMs_ = 0;
    loaded_ = 0;
    const Stopwatch geometry;
    IndexView view = indexView(scene.camera, volume_.indexToWorld);
    view.seeThrough(sample.pixel);
    view_ = view;
    std::vector<glm::dvec4> planes = indexPlanes(scene, volume_, backgroundVisible_);
    const bool lit = occlusionMethod(scene) == Method::lightVolume;
    if (lit) {
      light_.update(
          voxels_, scene,
          sample.lights.empty() ? lightDirections(scene, scene.occlusion.ordinates.directions) : sample.lights, planes);
      stats_.lightMs = light_.ms();
      stats_.directions = light_.stats().directions;
      stats_.windowUpdates = light_.stats().updates;
    }
    if (scene.camera.projection == Projection::orthographic) planes.push_back(frontPlane(scene, volume_));
    const ShearWarpSampling sampling = sampling_.value_or(shearWarpSampling(scene, volume_));
    const Stopwatch sweep;
    stats_.geometryMs = geometry.elapsedMs() - stats_.lightMs;
    if (!voxels_.bricks().empty()) drawLattices(scene, view, planes, sampling, lit);
    stats_.sweepMs = sweep.elapsedMs();
    stats_.bricks = volume_.bricks.size();
    stats_.visibleBricks = stats_.brickSlots = voxels_.bricks().size();
    stats_.textureBytes = voxels_.bytes();
    drawn_ = true;
  }

  Picture read(const ResolvedScene& scene) {
    if (!drawn_) throw InvalidArgument("render: nothing was drawn since the scene changed");
    const Stopwatch watch;
    Picture picture;
    const int width = scene.camera.width, height = scene.camera.height;
    picture.colour = Image(width, height, 4);
    if (options_.visibilityAndDepth)
      for (Image* image : {&picture.visibility, &picture.depth, &picture.opacity}) *image = Image(width, height, 1);
    tbb::parallel_for(tbb::blocked_range<int>(0, height, 8), [&](const auto& rows) {
      std::vector<WarpedPixel> pixels(static_cast<std::size_t>(width));
      for (int y = rows.begin(); y != rows.end(); ++y) {
        std::ranges::fill(pixels, WarpedPixel());
        for (const LatticePicture& part : pictures_) warpRow(part, view_, y, pictures_.size() > 1, pixels);
        for (int x = 0; x < width; ++x) storePixel(scene, x, y, pixels[static_cast<std::size_t>(x)], picture);
      }
    });
    picture.stats = stats_;
    picture.stats.readMs = watch.elapsedMs();
    return picture;
  }

  void forget() { drawn_ = false; }

 private:
  void drawLattices(const ResolvedScene& scene, const IndexView& view, const std::vector<glm::dvec4>& planes,
                    const ShearWarpSampling& sampling, bool lit) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const auto& brick : voxels_.bricks()) {
      low = glm::min(low, glm::dvec3(brick->origin) - 1.0);
      high = glm::max(high, glm::dvec3(brick->origin + volume_.layout.interior));
    }
    LatticeOptions options;
    options.raysPerVoxel = sampling.raysPerVoxel;
    options.raysPerPixel = sampling.raysPerPixel;
    const Box domain{glm::dvec3(volume_.domain.min), glm::dvec3(volume_.domain.max)};
    const std::vector<RayLattice> lattices =
        rayLattices(view, glm::dmat3(volume_.indexToWorld), domain, low, high, options);
    double done = 0;
    for (const RayLattice& lattice : lattices) {
      const BrickRows rows(voxels_, lattice);
      MarchFrame frame;
      frame.lattice = &lattice;
      frame.voxels = &voxels_;
      frame.rows = &rows;
      frame.table = &*table_;
      for (const double at : slicesOf(lattice, rows, sampling.slicesPerVoxel))
        frame.slices.push_back({at, lattice.start(at), lattice.spacing(at)});
      for (const glm::dvec4& plane : planes)
        frame.planes.emplace_back(plane[lattice.u], plane[lattice.v], plane[lattice.n], plane.w);
      frame.saturation = static_cast<float>(scene.sampling.saturation);
      frame.midpoint = scene.sampling.quadrature == Quadrature::midpoint;
      frame.aux = options_.visibilityAndDepth;
      frame.lights = lit ? light_.channels() : 0;
      frame.lightUnit = light_.unit();
      const glm::dvec3 whole = lit ? light_.whole() : glm::dvec3(1);
      const double power = whole.r + whole.g + whole.b;
      for (int c = 0; c < 3; ++c)
        frame.power[static_cast<std::size_t>(c)] = static_cast<float>(power > 0 ? whole[c] / power : 0);
      whole_ = glm::vec3(whole);
      LatticePicture picture;
      picture.lattice = lattice;
      picture.stride = lattice.width;
      const auto rays = static_cast<std::size_t>(lattice.width) * static_cast<std::size_t>(lattice.height);
      picture.colour.assign(rays, glm::vec4(0));
      picture.filled.assign(static_cast<std::size_t>(lattice.height), 0);
      if (frame.aux) picture.aux.assign(rays, glm::vec2(0));
      stats_.bufferBytes += rays * sizeof(glm::vec4);
      stats_.slices += static_cast<std::int64_t>(frame.slices.size());
      if (frame.slices.size() > 1) march(frame, picture, done, 1.0 / static_cast<double>(lattices.size()));
      pictures_.push_back(std::move(picture));
      done += 1.0 / static_cast<double>(lattices.size());
    }
  }

  void march(const MarchFrame& frame, LatticePicture& picture, double done, double share) {
    tbb::enumerable_thread_specific<RowMarch> marches([&] { return RowMarch(frame); });
    std::atomic<int> rows{0};
    std::atomic<std::uint64_t> samples{0};
    const auto caller = std::this_thread::get_id();
    tbb::parallel_for(tbb::blocked_range<int>(0, picture.lattice.height, 2), [&](const auto& range) {
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

  void storePixel(const ResolvedScene& scene, int x, int y, const WarpedPixel& pixel, Picture& picture) const {
    const auto at =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(scene.camera.width) + static_cast<std::size_t>(x);
    float* out = &picture.colour.pixels[4 * at];
    const float opacity = std::clamp(pixel.colour.w, 0.0f, 1.0f), through = 1 - opacity;
    for (int c = 0; c < 3; ++c) {
      out[c] = std::max(pixel.colour[c], 0.0f) * whole_[c] * static_cast<float>(scene.ambient[c]);
      if (scene.background) out[c] += through * static_cast<float>((*scene.background)[c]);
    }
    out[3] = scene.background ? 1 : opacity;
    if (!options_.visibilityAndDepth) return;
    picture.visibility.pixels[at] = pixel.aux.x;
    picture.opacity.pixels[at] = opacity;
    const float depth = opacity > 0 ? pixel.aux.y / opacity : std::numeric_limits<float>::infinity();
    picture.depth.pixels[at] = depth;
  }

  const Bricks& volume_;
  RenderOptions options_;
  std::optional<ShearWarpSampling> sampling_;
  BrickVoxels voxels_;
  BrickLight light_;
  std::optional<MediumTable> table_;
  bool backgroundVisible_ = false, drawn_ = false;
  double loadMs_ = 0;         // of bricks since the last picture
  std::uint64_t loaded_ = 0;  // their number
  IndexView view_;
  std::vector<LatticePicture> pictures_;
  glm::vec3 whole_{1};
  RenderStats stats_;
};

ShearWarpRenderer::ShearWarpRenderer(const Bricks& volume, const ResolvedScene& scene, const RenderOptions& options,
                                     std::optional<ShearWarpSampling> sampling)
    : implementation_(std::make_unique<Implementation>(volume, options, sampling)) {
  setScene(scene);
}

ShearWarpRenderer::~ShearWarpRenderer() = default;

void ShearWarpRenderer::update(const ResolvedScene& next) {
  implementation_->forget();
  implementation_->update(next, hasScene() ? &scene() : nullptr);
}

void ShearWarpRenderer::draw(const RenderSample& sample) { implementation_->draw(scene(), sample); }

Picture ShearWarpRenderer::read() { return implementation_->read(scene()); }

}  // namespace umbrick
