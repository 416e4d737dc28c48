// SPDX-License-Identifier: Apache-2.0
#include "umbrick/reference/reference.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <mutex>
#include <optional>
#include <string>

#include "reference/hybrid_pixel.h"
#include "reference/monte_carlo.h"
#include "reference/quadrature.h"
#include "reference/value_pixel.h"
#include "umbrick/core/error.h"
#include "umbrick/core/memory.h"
#include "umbrick/core/pixel_points.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/optics/projection_colour.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {
namespace {

constexpr int kTile = 8;  // pixels along the edge of a tile, which one thread takes at once

template <class T>
void checkAtLeast(const char* field, T value, T least) {
  if (!(value >= least) || !std::isfinite(static_cast<double>(value)))
    throw InvalidArgument(std::string(field) + " is " + std::to_string(value) + ", must be at least " +
                          std::to_string(least));
}

void check(const ScalarGrid& grid, const ResolvedScene& scene, const ReferenceOptions& options) {
  if (!grid.grid) throw InvalidArgument("reference: there is no grid");
  checkAtLeast("step", options.step, 0.0);
  checkAtLeast("directions", options.directions, 1);
  checkAtLeast("samples", options.samples, 2);
  if (options.integrator == Integrator::monteCarlo && options.samples < 2 * scene.sampling.pixelSamples)
    throw InvalidArgument("samples is " + std::to_string(options.samples) + ", must be at least " +
                          std::to_string(2 * scene.sampling.pixelSamples) + ", two for each sample of a pixel");
  checkAtLeast("standard error", options.standardError, 0.0);
  checkAtLeast("threads", options.threads, 0);
  if (!(options.tolerance > 0 && options.tolerance <= 1))
    throw InvalidArgument("tolerance is " + std::to_string(options.tolerance) + ", must be in (0, 1]");
  requireClassification(scene);
  if (scene.sampling.classification == Classification::pre && options.integrator == Integrator::monteCarlo)
    throw InvalidArgument("sampling.classification: pre is integrated by quadrature, not by Monte Carlo");
  if (!options.lights.empty() && !traitsOf(scene.model).directions)
    throw InvalidArgument("lights: are given, but the model " + modelName(scene.model) + " does not take a list");
  for (const auto& [direction, radiance] : options.lights) {
    if (!(std::abs(glm::length(direction) - 1) < 1e-6))
      throw InvalidArgument("lights: a direction has length " + std::to_string(glm::length(direction)) + ", must be 1");
    const double darkest = std::min({radiance.r, radiance.g, radiance.b});
    if (!(darkest >= 0) || !std::isfinite(powerOf(radiance)))
      throw InvalidArgument("lights: a radiance is [" + std::to_string(radiance.r) + ", " + std::to_string(radiance.g) +
                            ", " + std::to_string(radiance.b) + "], must be three finite numbers of 0 or more");
  }
}

std::optional<LightSet> lightsOf(const ResolvedScene& scene, const ReferenceOptions& options) {
  const ModelTraits& model = traitsOf(scene.model);
  // All of the sphere is alike, and needs no list.
  if (!model.directions || (model.sphere && options.lights.empty())) return std::nullopt;
  return options.lights.empty() ? LightSet(scene) : LightSet(options.lights);
}

// What the quadrature sums over, where it is the same for all pixels.
std::vector<LightDirection> directionsOf(const ResolvedScene& scene, const ReferenceOptions& options,
                                         const LightSet* lights) {
  if (options.integrator != Integrator::quadrature) return {};
  // A light of its own makes each list of directions, and they are put together.
  requireMemory("directions: a list of " + std::to_string(options.directions),
                2.0 * sizeof(LightDirection) * options.directions);
  if (traitsOf(scene.model).sphere && !lights) return evenLight(sphereDirections(options.directions));
  if (!lights) return {};
  return options.lights.empty() ? lights->directions(options.directions, 0) : options.lights;
}

ReferencePicture blankPicture(const Camera& camera) {
  // Ten numbers a pixel, and as many again where they are written.
  requireMemory(
      "camera.size: a picture of " + std::to_string(camera.width) + " x " + std::to_string(camera.height) + " pixels",
      2 * 10.0 * sizeof(float) * camera.width * camera.height);
  ReferencePicture picture;
  picture.colour = Image(camera.width, camera.height, 4);
  picture.visibility = Image(camera.width, camera.height, 1);
  picture.depth = Image(camera.width, camera.height, 1);
  picture.standardError = Image(camera.width, camera.height, 4);
  return picture;
}

void store(const PixelResult& pixel, const ResolvedScene& scene, int x, int y, ReferencePicture& picture) {
  const glm::dvec3 behind = scene.background ? *scene.background : glm::dvec3(0);
  for (int i = 0; i < 3; ++i) {
    picture.colour.at(x, y)[i] =
        static_cast<float>(pixel.light[i] * scene.ambient[i] + pixel.emitted[i] + (1 - pixel.opacity) * behind[i]);
    // A path either scatters or gets through. The two never covary upwards, so this bounds the variance of the
    // sum from above. A path that gets through light that is emitted finds more of it, so that errors are added there.
    const double light = std::sqrt(pixel.variance[i]) * (scene.emitted ? 1 : scene.ambient[i]);
    const double through = std::sqrt(pixel.variance[3]) * behind[i];
    picture.standardError.at(x, y)[i] =
        static_cast<float>(scene.emitted ? light + through : std::hypot(light, through));
  }
  picture.colour.at(x, y)[3] = scene.background ? 1.0f : static_cast<float>(pixel.opacity);
  picture.standardError.at(x, y)[3] = scene.background ? 0.0f : static_cast<float>(std::sqrt(pixel.variance[3]));
  *picture.visibility.at(x, y) = static_cast<float>(pixel.visibility);
  *picture.depth.at(x, y) =
      pixel.opacity > 0 ? static_cast<float>(pixel.depth / pixel.opacity) : std::numeric_limits<float>::infinity();
}

// Reports how far the work is, from one thread at a time, and whether to go on.
class Progress {
 public:
  Progress(const std::function<bool(double)>& report, std::size_t total) : report_(report), total_(total) {}
  bool stopped() const { return stopped_.load(std::memory_order_relaxed); }
  void add() {
    ++done_;
    goOn();
  }
  bool goOn() {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (report_ && lock.owns_lock() && !report_(static_cast<double>(done_) / static_cast<double>(total_)))
      stopped_ = true;
    return !stopped();
  }
  std::size_t done() const { return done_; }

 private:
  const std::function<bool(double)>& report_;
  std::size_t total_;
  std::atomic<std::size_t> done_ = 0;
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
};

// Integrates all pixels, each tile in one thread. The result of a pixel does not depend on the thread that takes it.
template <class MakeIntegrator, class Store>
RayCounts integrateAll(const ResolvedScene& scene, const ReferenceOptions& options,
                       const MakeIntegrator& makeIntegrator, const Store& storePixel, ReferencePicture& picture) {
  const int width = scene.camera.width, height = scene.camera.height;
  const int columns = (width + kTile - 1) / kTile, rows = (height + kTile - 1) / kTile;
  const std::size_t tiles = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  Progress progress(options.progress, pixels);
  const GoOn goOn = [&] { return progress.goOn(); };
  std::atomic<std::uint64_t> unconverged = 0;
  using Integrator = decltype(makeIntegrator(goOn));
  tbb::enumerable_thread_specific<Integrator> integrators([&] { return makeIntegrator(goOn); });
  // More threads than there are cores are granted, too.
  std::optional<tbb::global_control> limit;
  if (options.threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
  tbb::task_arena arena(options.threads > 0 ? options.threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tiles, 1), [&](const auto& range) {
      auto& integrator = integrators.local();
      for (std::size_t tile = range.begin(); tile != range.end() && !progress.stopped(); ++tile) {
        const int left = static_cast<int>(tile % static_cast<std::size_t>(columns)) * kTile;
        const int bottom = static_cast<int>(tile / static_cast<std::size_t>(columns)) * kTile;
        for (int y = bottom; y < std::min(bottom + kTile, height); ++y)
          for (int x = left; x < std::min(left + kTile, width) && !progress.stopped(); ++x) {
            const auto pixel = integrator.integrate(x, y);
            if (!pixel) continue;
            if (!storePixel(*pixel, x, y)) ++unconverged;
            progress.add();
          }
      }
    });
  });
  picture.stats.unconvergedPixels = unconverged;
  picture.complete = progress.done() == pixels;
  picture.stats.share = static_cast<double>(progress.done()) / static_cast<double>(pixels);
  RayCounts counts;
  for (const auto& integrator : integrators) counts.add(integrator.counts());
  return counts;
}

void countWork(const RayCounts& counts, ReferenceStats& stats) {
  stats.eyeRays = counts.eyeRays;
  stats.lightRays = counts.lightRays;
  stats.cells = counts.cells;
  stats.samples = counts.samples;
}

// Composites a premultiplied colour over the scene's background.
void storeColour(const glm::dvec4& colour, const ResolvedScene& scene, float* out) {
  const glm::dvec3 behind = scene.background.value_or(glm::dvec3(0));
  for (int c = 0; c < 3; ++c) out[c] = static_cast<float>(colour[c] + (1 - colour.w) * behind[c]);
  out[3] = scene.background ? 1.0f : static_cast<float>(colour.w);
}

// The layers of modes that show values.
struct ValueLayers {
  explicit ValueLayers(const ResolvedScene& scene)
      : surfaces(traitsOf(scene.mode).surfaces),
        value(scene.camera.width, scene.camera.height, 1),
        position(surfaces ? scene.camera.width : 0, scene.camera.height, 3),
        normal(position) {}

  void store(const ValueResult& pixel, int x, int y) {
    *value.at(x, y) = static_cast<float>(pixel.value);
    for (int c = 0; surfaces && c < 3; ++c) {
      position.at(x, y)[c] = static_cast<float>(pixel.position[c]);
      normal.at(x, y)[c] = static_cast<float>(pixel.normal[c]);
    }
  }
  void moveTo(ReferencePicture& picture) {
    picture.layers.push_back({"value", std::move(value), true});
    if (!surfaces) return;
    picture.layers.push_back({"position", std::move(position), true});
    picture.layers.push_back({"normal", std::move(normal), true});
  }

  bool surfaces;
  Image value, position, normal;
};

void storeValue(const ValueResult& pixel, const ResolvedScene& scene, int x, int y, ReferencePicture& picture,
                ValueLayers& layers) {
  storeColour(pixel.colour, scene, picture.colour.at(x, y));
  *picture.visibility.at(x, y) = static_cast<float>(traitsOf(scene.mode).surfaces ? pixel.visibility : pixel.colour.w);
  *picture.depth.at(x, y) =
      pixel.colour.w > 0 ? static_cast<float>(pixel.depth / pixel.colour.w) : std::numeric_limits<float>::infinity();
  layers.store(pixel, x, y);
}

// Turns opacities into what gets through.
void showThrough(const ResolvedScene& scene, ReferencePicture& picture) {
  Image through(scene.camera.width, scene.camera.height, 1);
  for (std::size_t i = 0; i < through.pixels.size(); ++i) {
    float* const pixel = &picture.colour.pixels[4 * i];
    through.pixels[i] = 1 - pixel[3];
    storeColour(pixel[3] > 0 ? xrayColour(through.pixels[i]) : glm::dvec4(0), scene, pixel);
  }
  picture.layers.push_back({"value", std::move(through), true});
}

// Returns the scene of the medium that a mode looks through.
ResolvedScene mediumOf(const ResolvedScene& scene) {
  ResolvedScene medium = scene;
  medium.mode = Mode::integrate;
  if (scene.mode == Mode::integrate) return medium;
  medium.background.reset();
  if (scene.mode == Mode::xray) medium.model = Model::emission;
  return medium;
}

void checkMedium(const ResolvedScene& medium, const ReferenceOptions& options) {
  if (medium.mesh.shape && options.integrator == Integrator::monteCarlo)
    throw InvalidArgument("mesh: a scene with one is integrated by quadrature, not by Monte Carlo");
  if (!isShaded(medium)) return;
  if (options.integrator == Integrator::monteCarlo)
    throw InvalidArgument("shading.kind: phong in a medium is integrated by quadrature, not by Monte Carlo");
}

// The medium of a scene, and all that its pixels share.
class MediumSpace {
 public:
  /// @param scene  outlives this
  MediumSpace(const ScalarGrid& grid, const ResolvedScene& scene, const ReferenceOptions& options)
      : lights_(lightsOf(scene, options)),
        indexToWorld_(grid.indexToWorld()),
        classifier_(scene.transfer),
        emission_(emissionOf(grid, scene)),
        field_(grid, classifier_, scene.gradients, options.skipEmpty, emission_ ? &*emission_ : nullptr),
        rays_(scene.camera, indexToWorld_),
        region_(scene, mediumBox(scene.transfer, field_.domain()), indexToWorld_,
                traitsOf(scene.model).behindEye || lightComesFromBehind(scene)),
        directions_(directionsOf(scene, options, given())),
        places_(pixelPoints(scene.sampling.pixelSamples)),
        mesh_(meshEnds(scene, indexToWorld_)),
        space_{field_,
               classifier_,
               rays_,
               region_,
               scene,
               given(),
               directions_,
               places_,
               grid,
               mesh_ ? &*mesh_ : nullptr,
               emission_ ? &*emission_ : nullptr} {}
  MediumSpace(const MediumSpace&) = delete;  // its space refers to it
  MediumSpace& operator=(const MediumSpace&) = delete;

  const ReferenceSpace& space() const { return space_; }
  double voxelEdge() const { return shortestVoxelEdge(indexToWorld_); }

 private:
  const LightSet* given() const { return lights_ ? &*lights_ : nullptr; }
  static std::optional<Classifier> emissionOf(const ScalarGrid& grid, const ResolvedScene& scene) {
    if (!scene.emitted) return std::nullopt;
    if (!grid.emission)
      throw InvalidArgument("volume.emissionGrid: '" + scene.volume.emissionGrid + "' is no part of the grid \"" +
                            grid.name + "\"");
    requireDarkBackground(*scene.emitted, grid.emissionBackground());
    return std::optional<Classifier>(*scene.emitted);
  }

  std::optional<LightSet> lights_;
  glm::dmat4 indexToWorld_;
  Classifier classifier_;
  std::optional<Classifier> emission_;
  Field field_;
  EyeRays rays_;
  ConvexRegion region_;
  std::vector<LightDirection> directions_;
  std::vector<glm::dvec2> places_;
  std::optional<MeshEnds> mesh_;
  ReferenceSpace space_;
};

void describeField(const Field& field, const Stopwatch& watch, ReferenceStats& stats) {
  stats.fieldMs = watch.elapsedMs();
  stats.nonFiniteVoxels = field.nonFiniteVoxels();
  stats.blocks = field.blocks();
}

// A pixel of surfaces, and of the light around them.
class LitPixel {
 public:
  LitPixel(const ValueSpace& surfaces, const MediumSpace* medium, const std::vector<glm::dvec2>& places,
           const MeshEnds* mesh, const ReferenceOptions& options, const GoOn& goOn)
      : pixel_(surfaces, places, mesh) {
    if (medium) light_.emplace(medium->space(), options, options.step * medium->voxelEdge(), medium->voxelEdge(), goOn);
  }
  std::optional<ValueResult> integrate(int x, int y) { return pixel_.integrate(x, y, light_ ? &*light_ : nullptr); }
  RayCounts counts() const {
    RayCounts counts = pixel_.counts();
    if (light_) counts.add(light_->counts());
    return counts;
  }

 private:
  ValuePixel pixel_;
  std::optional<QuadraturePixel> light_;
};

// Renders projections of values and isosurfaces.
ReferencePicture renderValues(const ScalarGrid& grid, const ResolvedScene& scene, const ReferenceOptions& options) {
  const bool lit = traitsOf(scene.mode).surfaces && traitsOf(scene.model).occlusion;
  if (lit && options.integrator == Integrator::monteCarlo)
    throw InvalidArgument("mode: " + modeName(scene.mode) + " with the model " + modelName(scene.model) +
                          " is integrated by quadrature, not by Monte Carlo");
  ReferencePicture picture = blankPicture(scene.camera);
  const Stopwatch prepare;
  const ValueSpace space(grid, scene, options.skipEmpty);
  const ResolvedScene around = mediumOf(scene);
  std::optional<MediumSpace> medium;
  if (lit) medium.emplace(grid, around, options);
  describeField(space.field(), prepare, picture.stats);
  const std::vector<glm::dvec2> places = pixelPoints(scene.sampling.pixelSamples);
  const std::optional<MeshEnds> mesh = meshEnds(scene, grid.indexToWorld());
  ValueLayers layers(scene);
  const Stopwatch integrate;
  const RayCounts counts = integrateAll(
      scene, options,
      [&](const GoOn& goOn) {
        return LitPixel(space, medium ? &*medium : nullptr, places, mesh ? &*mesh : nullptr, options, goOn);
      },
      [&](const ValueResult& pixel, int x, int y) {
        storeValue(pixel, scene, x, y, picture, layers);
        return true;
      },
      picture);
  picture.stats.integrateMs = integrate.elapsedMs();
  countWork(counts, picture.stats);
  layers.moveTo(picture);
  return picture;
}

// Renders a medium.
// @param whole  null: the medium alone; else the scene of the mode hybrid, whose surfaces it lies behind
ReferencePicture renderMedium(const ScalarGrid& grid, const ResolvedScene& scene, const ReferenceOptions& options,
                              const ResolvedScene* whole = nullptr) {
  checkMedium(scene, options);
  ReferencePicture picture = blankPicture(scene.camera);
  const Stopwatch prepare;
  const MediumSpace medium(grid, scene, options);
  const ReferenceSpace& space = medium.space();
  describeField(space.field, prepare, picture.stats);
  const Stopwatch integrate;
  RayCounts counts;
  const double edge = medium.voxelEdge();
  const auto keep = [&](const PixelResult& pixel, int x, int y) {
    store(pixel, scene, x, y, picture);
    return pixel.converged;
  };
  if (whole) {
    const ValueSpace surfaces(grid, *whole, options.skipEmpty);
    ValueLayers layers(*whole);
    counts = integrateAll(
        scene, options,
        [&](const GoOn& goOn) { return HybridPixel(surfaces, space, options, options.step * edge, edge, goOn); },
        [&](const ValueResult& pixel, int x, int y) {
          storeValue(pixel, *whole, x, y, picture, layers);
          return true;
        },
        picture);
    layers.moveTo(picture);
  } else if (options.integrator == Integrator::monteCarlo) {
    counts = integrateAll(
        scene, options, [&](const GoOn& goOn) { return MonteCarloPixel(space, options, edge, goOn); }, keep, picture);
  } else {
    counts = integrateAll(
        scene, options,
        [&](const GoOn& goOn) { return QuadraturePixel(space, options, options.step * edge, edge, goOn); }, keep,
        picture);
  }
  picture.stats.integrateMs = integrate.elapsedMs();
  countWork(counts, picture.stats);
  return picture;
}

}  // namespace

ReferencePicture renderReference(const ScalarGrid& grid, const ResolvedScene& scene, const ReferenceOptions& options) {
  check(grid, scene, options);
  validateScene(scene);
  requireMode(scene, Technique::rays);
  if (scene.mode == Mode::hybrid) {
    if (options.integrator == Integrator::monteCarlo)
      throw InvalidArgument("mode: hybrid is integrated by quadrature, not by Monte Carlo");
    return renderMedium(grid, mediumOf(scene), options, &scene);
  }
  if (!traitsOf(scene.mode).medium) return renderValues(grid, scene, options);
  if (scene.mode == Mode::xray && scene.mesh.shape)
    throw InvalidArgument("mesh: the mode xray is not integrated with one by the reference but rendered by rays");
  ReferencePicture picture = renderMedium(grid, mediumOf(scene), options);
  if (scene.mode == Mode::xray) showThrough(scene, picture);
  return picture;
}

}  // namespace umbrick
