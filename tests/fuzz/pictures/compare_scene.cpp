// SPDX-License-Identifier: Apache-2.0
#include "fuzz/pictures/compare_scene.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/mat3x3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "fuzz/pictures/dice.h"
#include "fuzz/pictures/same_scene.h"
#include "fuzz/pictures/short_number.h"
#include "fuzz/pictures/slab_picture.h"
#include "umbrick/brick/brick_grid.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/reference/reference.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/shade/prepare.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick {
namespace {

// What the table of the transfer function may cost beside the slabs: a bin of 256 is 0.4 % of the range.
constexpr double kFloor = 3e-3;
// Two integrators that know no bricks: a ray that grazes what is solid meets it in one of them.
constexpr double kReferenceFloor = 1e-3;
// Light of a lattice: which texel a path goes through may turn on a rounding, and the extent of the volume decides how
// large texels are.
constexpr double kLattice = 3e-3;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

PictureDistance distance(const Image& a, const Image& b) {
  PictureDistance result;
  if (a.pixels.size() != b.pixels.size()) return {kInfinity, kInfinity, {}};
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    double difference = std::abs(double(a.pixels[i]) - double(b.pixels[i]));
    // A difference that is no number is the largest of all.
    if (!std::isfinite(difference)) difference = kInfinity;
    if (difference > result.max) {
      const int pixel = static_cast<int>(i / 4);
      result.max = difference;
      result.worst = {pixel % a.width, pixel / a.width};
    }
    sum += difference * difference;
  }
  result.rms = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, a.pixels.size())));
  return result;
}

std::string pixelOf(const Image& image, const glm::ivec2& at) {
  const float* pixel = image.at(at.x, at.y);
  return shortNumber(pixel[0]) + " " + shortNumber(pixel[1]) + " " + shortNumber(pixel[2]) + " " +
         shortNumber(pixel[3]);
}

// A picture, and what is needed for another one of the same bricks.
struct Rendering {
  std::unique_ptr<Bricks> bricks;
  std::unique_ptr<SliceRenderer> renderer;
  Image colour, depth;
  RenderStats stats;
};

Rendering render(const GlContext& context, const ScalarGrid& grid, ResolvedScene scene,
                 const RenderOptions& options = {}, const AtlasLimits& limits = {}) {
  const glm::dmat4 toWorld = grid.indexToWorld();
  scene.bricks.interior = brickInterior(scene, toWorld, grid.worldBounds());
  BrickOptions cut;
  cut.interior = scene.bricks.interior;
  cut.apron = requiredApron(scene, toWorld);
  cut.gradients = scene.transfer.is2d();
  Rendering rendering;
  rendering.bricks = cutGrid(grid, cut, scene.bricks.bricked);
  rendering.renderer = std::make_unique<SliceRenderer>(context, *rendering.bricks, scene, options, limits);
  Picture picture = rendering.renderer->render();
  rendering.colour = std::move(picture.colour);
  rendering.depth = std::move(picture.depth);
  rendering.stats = picture.stats;
  return rendering;
}

// Displaces all samples by what rounding may move them. Clip planes stay: those are cut per ray.
Camera displaced(Camera camera, const glm::dmat4& toWorld, double voxels) {
  const glm::dvec3 shift = glm::dmat3(toWorld) * glm::dvec3(voxels, 0.7 * voxels, -0.8 * voxels);
  camera.eye += shift;
  camera.lookAt += shift;
  return camera;
}

// 1, or more where light or background are brighter.
double brightestOf(const ResolvedScene& scene) {
  glm::dvec3 arriving(1);
  if (scene.model == Model::lights) {
    arriving = glm::dvec3(0);
    for (const LightDirection& light : lightDirections(scene, 1)) arriving += light.radiance;
  }
  const glm::dvec3 light = glm::max(scene.ambient * arriving, scene.background.value_or(glm::dvec3(0)));
  return std::max({1.0, light.r, light.g, light.b});
}

class Comparer {
 public:
  Comparer(const GlContext& context, const RandomScene& random, const CompareOptions& options)
      : context_(context),
        grid_(random.grid),
        scene_(random.scene),
        options_(options),
        toWorld_(grid_.indexToWorld()),
        emission_(scene_.model == Model::emission),
        brightest_(brightestOf(scene_)) {}

  SceneComparison compare() {
    const Stopwatch watch;
    if (attempt("base", [&] { base_ = render(context_, grid_, scene_); })) {
      attempt("reference", [&] { compareWithReference(); });
      attempt("rounding", [&] { measureRounding(); });
      compareVariants();
    }
    result_.seconds = watch.elapsedMs() / 1000;
    return std::move(result_);
  }

 private:
  // What throws is a failure of its own.
  template <class Action>
  bool attempt(const std::string& what, const Action& action) {
    try {
      action();
      return true;
    } catch (const Error& error) {
      result_.failures.push_back(what + ": " + error.what());
      return false;
    }
  }

  void require(const std::string& what, const Image& found, const Image& right, const PictureDistance& from,
               double limit) {
    if (from.rms <= limit) return;
    result_.failures.push_back(what + ": RMSE " + shortNumber(from.rms) + ", limit " + shortNumber(limit) + ", pixel " +
                               std::to_string(from.worst.x) + " " + std::to_string(from.worst.y) + " is " +
                               pixelOf(found, from.worst) + ", should be " + pixelOf(right, from.worst));
  }

  // Fixed point: each slab may be rounded by one and a half steps, see SamplingOptions.
  double bitsAllowance() const {
    return scene_.sampling.bits == 16 ? static_cast<double>(base_.stats.slices) * 1.5 * 0x1p-16 : 0;
  }

  // The reference by the directions that the renderer takes: their number is no error of the picture. The paper's own
  // method takes none.
  ReferencePicture exactPicture() const {
    ReferenceOptions reference;
    reference.tolerance = emission_ ? 1e-4 : 2e-3;
    if (!emission_ && scene_.method == Method::ordinates)
      reference.lights = lightDirections(scene_, scene_.occlusion.ordinates.directions);
    reference.directions = 64;
    return renderReference(grid_, scene_, reference);
  }

  ResolvedScene fineScene() const {
    ResolvedScene fine = scene_;
    fine.sampling.spacing = std::min(fine.sampling.spacing, 0.25 * shortestVoxelEdge(toWorld_));
    fine.sampling.segments = 4;
    fine.sampling.quadrature = Quadrature::preintegrated;
    fine.sampling.bits = fine.occlusion.bits = 32;
    if (fine.method == Method::ordinates) fine.occlusion.ordinates.scale = 3;
    return fine;
  }

  void compareWithReference() {
    const ReferencePicture reference = exactPicture();
    const Image& exact = reference.colour;
    double alpha = 0;
    for (std::size_t i = 3; i < exact.pixels.size(); i += 4) alpha += exact.pixels[i];
    result_.opacity = 4 * alpha / static_cast<double>(exact.pixels.size());
    result_.render = distance(base_.colour, exact);
    const IndexBox& domain = base_.bricks->domain;
    const ResolvedScene fine = fineScene();
    // What is not finite is wrong for every model.
    double limit = std::numeric_limits<double>::max(), fineLimit = limit;
    if (emission_) {
      result_.slabs = distance(slabPicture(grid_, scene_, domain), exact);
      limit = 1.25 * result_.slabs.rms + brightest_ * (kFloor + scene_.sampling.saturation + bitsAllowance());
      result_.fineSlabs = distance(slabPicture(grid_, fine, domain), exact);
      fineLimit = 1.25 * result_.fineSlabs.rms + brightest_ * (kFloor + scene_.sampling.saturation);
      // What is left at eighths of cells is a third of what halving them changed, by their order; of peaks that rays
      // graze, few pixels tell: twice as much.
      const Image finest = cellPicture(grid_, fine, domain, 8);
      const PictureDistance halving = distance(cellPicture(grid_, fine, domain, 4), finest);
      result_.reference = distance(exact, finest);
      result_.referenceLimit = 2 * halving.rms + brightest_ * kReferenceFloor;
      require("reference", exact, finest, result_.reference, result_.referenceLimit);
    }
    result_.renderLimit = limit;
    require("base", base_.colour, exact, result_.render, limit);
    RenderOptions layers;
    layers.visibilityAndDepth = true;
    const Rendering rendered = render(context_, grid_, fine, layers);
    result_.fineRender = distance(rendered.colour, exact);
    result_.fineLimit = fineLimit;
    require("fine", rendered.colour, exact, result_.fineRender, fineLimit);
    compareDepths(rendered, reference, fine);
  }

  // Depths are those of the middles of slabs, which may be off by half of one; where light comes from depends on
  // colours as far as those may be off, over the way through the medium. Weighted by opacity, in voxels.
  void compareDepths(const Rendering& rendered, const ReferencePicture& reference, const ResolvedScene& fine) {
    const double edge = shortestVoxelEdge(toWorld_);
    double sum = 0;
    for (std::size_t i = 0; i < rendered.depth.pixels.size(); ++i) {
      // A visible background makes pictures opaque, but no medium.
      const double a = rendered.depth.pixels[i], b = reference.depth.pixels[i];
      const double weight = std::min(rendered.colour.pixels[4 * i + 3], reference.colour.pixels[4 * i + 3]);
      if (weight <= 0 || (std::isinf(a) && std::isinf(b))) continue;
      const double difference = weight * std::abs(a - b) / edge;
      if (!scene_.background || std::isfinite(difference)) sum += difference * difference;
    }
    result_.depth = std::sqrt(sum / static_cast<double>(rendered.depth.pixels.size()));
    const double way = glm::length(grid_.worldBounds().extent()) / edge + 2;
    result_.depthLimit = 0.5 * fine.sampling.spacing / edge + 2 * result_.fineLimit * way;
    if (!(result_.depth <= result_.depthLimit))
      result_.failures.push_back("depth: RMS " + shortNumber(result_.depth) + " voxels, limit " +
                                 shortNumber(result_.depthLimit));
  }

  // As the check of invariants has it: texture coordinates are rounded to some units in the last place of 24 bits. So
  // is the value that is interpolated, which a value that changes by all of its range from voxel to voxel makes a
  // distance.
  void measureRounding() {
    const Range value = base_.bricks->value;
    const double magnitude = std::max(std::abs(double(value.min)), std::abs(double(value.max)));
    // An outlier widens the range, but not the part of it where the function varies.
    const float varying = scene_.transfer.valueDomain().extent();
    const double extent = varying > 0 ? std::min(varying, value.extent()) : value.extent();
    const double ofValue = extent > 0 ? magnitude / extent : 0;
    // Planes cut at depths from the eye, in single precision, too.
    const bool cut = !scene_.clipPlanes.empty() || scene_.clipBox || scene_.camera.nearDistance > 0 ||
                     scene_.transfer(base_.bricks->background).sigma_t > 0;
    const double depth =
        cut ? glm::distance(scene_.camera.eye, grid_.worldBounds().centre()) / shortestVoxelEdge(toWorld_) : 0;
    const double voxels = 16 * 0x1p-25 * (base_.stats.textureEdge + 64 + ofValue + depth);
    const Picture shifted = base_.renderer->render(displaced(scene_.camera, toWorld_, voxels));
    const PictureDistance moved = distance(shifted.colour, base_.colour);
    const double lastPlace = scene_.sampling.bits == 16 ? 0x1p-16 : 0x1p-24;
    rounding_ = 4 * moved.rms + brightest_ * 4 * static_cast<double>(base_.stats.slices + 16) * lastPlace;
    if (!emission_) rounding_ += brightest_ * kLattice;
  }

  // A picture that should be the scene's own.
  struct Variant {
    std::string name;
    double limit = 0;
    std::function<std::optional<Image>()> picture;  // none where it would be the same scene
  };

  std::vector<Variant> variants() {
    std::vector<Variant> all;
    ResolvedScene wide = scene_;
    wide.bricks.interior = kMostInterior;
    const double limit = rounding_ + saturation();
    for (SameScene& same : sameScenes(grid_, scene_, requiredApron(wide, toWorld_), options_.seed))
      all.push_back({same.name, limit,
                     [this, same = std::move(same)] { return render(context_, same.grid, same.scene).colour; }});
    all.push_back({"reversed", 0, [this] {
                     RenderOptions reversed;
                     reversed.reverseBricks = true;
                     return render(context_, grid_, scene_, reversed).colour;
                   }});
    all.push_back({"small budget", limit, [this] { return withSmallPool(); }});
    if (scene_.sampling.saturation > 0)
      all.push_back({"not saturated", limit, [this] {
                       ResolvedScene scene = scene_;
                       scene.sampling.saturation = 0;
                       return render(context_, grid_, scene).colour;
                     }});
    return all;
  }

  void compareVariants() {
    std::vector<Variant> chosen;
    attempt("variants", [&] { chosen = variants(); });
    Dice dice(options_.seed, 78);
    while (static_cast<int>(chosen.size()) > std::max(0, options_.variants))
      chosen.erase(chosen.begin() + dice.below(static_cast<int>(chosen.size())));
    for (const Variant& variant : chosen)
      attempt(variant.name, [&] {
        const std::optional<Image> colour = variant.picture();
        if (!colour) return;
        const PictureDistance from = distance(*colour, base_.colour);
        result_.variants.push_back({variant.name, from, variant.limit});
        require(variant.name, *colour, base_.colour, from, variant.limit);
      });
  }

  // Bricks decide how often saturated pixels are looked for, so that each picture leaves out as much.
  double saturation() const { return brightest_ * scene_.sampling.saturation; }

  // The smallest pool that holds what one slice needs, by a few trials; none where there are few bricks.
  std::optional<Image> withSmallPool() const {
    if (base_.stats.brickSlots < 4) return std::nullopt;
    for (double share = 1.0 / 8; share < 1; share *= 1.7) {
      AtlasLimits pool;
      pool.budgetBytes = static_cast<std::uint64_t>(share * static_cast<double>(base_.stats.textureBytes));
      try {
        return render(context_, grid_, scene_, {}, pool).colour;
      } catch (const InvalidArgument&) {
        // A slice needs more than this.
      }
    }
    return std::nullopt;
  }

  const GlContext& context_;
  const ScalarGrid& grid_;
  const ResolvedScene& scene_;
  const CompareOptions options_;
  const glm::dmat4 toWorld_;
  const bool emission_;
  const double brightest_;  // radiance that a picture may have; errors are relative to it
  Rendering base_;
  double rounding_ = 0;
  SceneComparison result_;
};

}  // namespace

SceneComparison compareScene(const GlContext& context, const RandomScene& random, const CompareOptions& options) {
  return Comparer(context, random, options).compare();
}

}  // namespace umbrick
