// SPDX-License-Identifier: Apache-2.0
#include "umbrick/draw/progressive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "umbrick/core/error.h"
#include "umbrick/core/pixel_points.h"
#include "umbrick/core/random.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/draw/picture_mean.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {
namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Returns the root of the mean of f(i) over R, G and B of all pixels.
template <class Value>
double rootMean(std::size_t values, const Value& squared) {
  double sum = 0;
  for (std::size_t i = 0; i < values; ++i)
    if (i % 4 != 3) sum += squared(i);
  return std::sqrt(std::max(0.0, sum) / (0.75 * static_cast<double>(values)));
}

// Moments of one number per stream: the mean, and the variance of that mean.
struct StreamMoments {
  double mean = 0, variance = 0;
};
template <class Value>
StreamMoments momentsOf(const Value& value) {
  StreamMoments moments;
  double square = 0;
  for (std::size_t k = 0; k < kStreams; ++k) moments.mean += value(k) / kStreams;
  for (std::size_t k = 0; k < kStreams; ++k) square += (value(k) - moments.mean) * (value(k) - moments.mean);
  moments.variance = square / (kStreams - 1) / kStreams;
  return moments;
}

// The samples of one stream.
class Stream {
 public:
  Stream(std::uint64_t seed, std::uint64_t number) {
    Random random(seed, number);
    seed_ = static_cast<std::uint64_t>(random.uniform() * 0x1p53);
    phase_ = random.uniform();
    for (int axis = 0; axis < 2; ++axis) {
      shift_[axis] = random.uniform();
      rounding_[axis] = random.uniform();
    }
    for (int axis = 0; axis < 2; ++axis) pixel_[axis] = random.uniform();
  }
  RenderSample sample(const ResolvedScene& scene, int pass, bool pixelArea) const {
    const int count = scene.occlusion.ordinates.directions;
    RenderSample sample;
    if (occlusionMethod(scene))
      sample.lights =
          lightSamples(scene, static_cast<std::uint64_t>(pass) * static_cast<std::uint64_t>(count), count, seed_);
    // A phase is in the open interval: at 0 a slice would lie in the eye.
    sample.phase = std::clamp(glm::fract(phase_ + pass * kGoldenStep), 1e-3, 1 - 1e-3);
    sample.latticeShift = glm::fract(shift_ + static_cast<double>(pass) * kR2Step);
    sample.rounding = glm::fract(rounding_ + static_cast<double>(pass) * kR2Step);
    if (pixelArea) sample.pixel = glm::fract(pixel_ + static_cast<double>(pass) * kR2Step);
    return sample;
  }

 private:
  std::uint64_t seed_ = 0;
  double phase_ = 0;
  glm::dvec2 shift_{0}, rounding_{0}, pixel_{0};
};

void check(const ResolvedScene& scene, const ProgressiveOptions& options) {
  const std::optional<Method> method = occlusionMethod(scene);
  if (!canAverage(scene))
    throw InvalidArgument(
        "progressive: needs the model emission, or cone, ambient or lights and the method ordinates or light-volume, "
        "found " +
        modelName(scene.model) + " and " + methodName(*method));
  if (options.passes < 1)
    throw InvalidArgument("progressive: passes is " + std::to_string(options.passes) + ", must be 1 or more");
  if (options.targetError > 0 && options.passes < kStreams)
    throw InvalidArgument("progressive: passes is " + std::to_string(options.passes) +
                          ", a target error needs at least " + std::to_string(kStreams));
  if (!(options.maxSeconds >= 0) || !(options.targetError >= 0))
    throw InvalidArgument("progressive: seconds and target error are " + std::to_string(options.maxSeconds) + " and " +
                          std::to_string(options.targetError) + ", must be 0 or more");
}

}  // namespace

double ErrorEstimate::total() const { return std::hypot(statistical, systematic); }

bool canAverage(const SceneSettings& scene) {
  const std::optional<Method> method = occlusionMethod(scene);
  return !method || (traitsOf(scene.model).directions && traitsOf(*method).directions);
}

ResolvedScene coarserScene(const ResolvedScene& scene) {
  ResolvedScene coarse = scene;
  coarse.sampling.spacing *= 2;
  coarse.occlusion.ordinates.scale =
      scene.occlusion.ordinates.scale / 2;  // 0 has been replaced by then, see renderProgressive
  return coarse;
}

namespace {

ResolvedScene finerScene(const ResolvedScene& scene) {
  ResolvedScene fine = scene;
  fine.sampling.spacing /= 2;
  fine.occlusion.ordinates.scale *= 2;
  return fine;
}

// Returns the error of a picture over its difference to one whose samples are `ratio` times as far apart: 1 / |ratio^p
// - 1| where errors fall with the order p. The result is the geometric mean of both ends of p.
double errorOverDifference(double ratio, const RaySampling& sampling) {
  const auto part = [&](double order) { return std::abs(std::pow(ratio, order) - 1); };
  return 1 / std::sqrt(part(sampling.leastOrder) * part(sampling.mostOrder));
}

// Light between voxels errs with the square of their distance where the medium is smooth, and with the distance at
// edges of what is solid.
constexpr RaySampling kLightOrders = {.leastOrder = 1, .mostOrder = 2};

// Returns the scene of one sample, which has one ray a pixel: the samples are what a pixel is averaged over.
ResolvedScene onePerPixel(ResolvedScene scene) {
  scene.sampling.pixelSamples = 1;
  return scene;
}

// Returns the scene with samples half as far apart; none where they would be closer than an eighth of a voxel, or the
// bricks were not cut for it. Where a technique takes samples no farther apart than so much, whatever the scene says,
// it is halved until they are closer.
std::optional<ResolvedScene> nextFiner(const Renderer& renderer, const ResolvedScene& scene) {
  const std::optional<RaySampling> now = renderer.sampling(scene);
  if (!now) return std::nullopt;
  for (ResolvedScene finer = finerScene(scene);; finer = finerScene(finer)) {
    const std::optional<RaySampling> sampling = renderer.sampling(finer);
    if (!sampling || sampling->spacing < now->voxelEdge / 8) return std::nullopt;
    if (sampling->spacing < now->spacing) return finer;
    if (finer.sampling.spacing < now->voxelEdge / 64) return std::nullopt;
  }
}

// The samples of one scene, rendered one after another.
class PassSeries {
 public:
  PassSeries(Renderer& renderer, const ResolvedScene& scene, const ProgressiveOptions& options)
      : renderer_(renderer), scene_(scene), pixelArea_(options.pixelArea) {
    for (int i = 0; i < kStreams; ++i) streams_.emplace_back(options.seed, static_cast<std::uint64_t>(i));
  }

  const ResolvedScene& scene() const { return scene_; }

  // Renders one more sample. The picture becomes the mean so far.
  void pass(Picture& picture, ErrorEstimate& error) {
    const auto stream = static_cast<std::size_t>(passes_ % kStreams);
    const RenderSample sample = streams_[stream].sample(scene_, passes_ / kStreams, pixelArea_);
    renderer_.setScene(onePerPixel(scene_));
    picture = renderer_.render(sample);
    means_[stream].add(picture.colour);
    all_.add(picture);
    if (passes_ == 0) choose(picture);
    // The other pictures have the same directions; only distances differ.
    for (Comparison& other : others_) {
      renderer_.setScene(onePerPixel(other.scene));
      other.pictures[stream] = renderer_.render(sample).colour;
    }
    if (++passes_ >= kStreams) error.statistical = standardError();
    if (passes_ == kStreams && !others_.empty()) {
      error.systematic = lightError_;
      for (const Comparison& other : others_)
        error.systematic = std::hypot(error.systematic, other.errorOverDifference * differenceTo(other));
      others_.clear();
    }
    all_.store(picture);
  }

 private:
  // A scene that the first picture of each stream is compared with.
  struct Comparison {
    ResolvedScene scene;
    double errorOverDifference = 1;
    std::array<Image, kStreams> pictures = {};
  };

  // Chooses the scenes that pictures are compared with.
  void choose(const Picture& first) {
    // From now on the automatic texel is that of the first picture, so that twice and half of it are what they say.
    sampling_ = renderer_.sampling(scene_);
    if (!sampling_) return;
    if (occlusionMethod(scene_) == Method::ordinates) {
      scene_.occlusion.ordinates.scale = sampling_->voxelEdge / first.stats.windowTexel;
      sampling_ = renderer_.sampling(scene_);
    }
    compareSampling();
    if (occlusionMethod(scene_) == Method::lightVolume) compareLight(first.stats);
  }

  // Coarser pictures cost less and finer ones more, but finer ones can be made from bricks with any apron, and of
  // samples that cannot be farther apart.
  void compareSampling() {
    std::optional<ResolvedScene> other = coarserScene(scene_);
    std::optional<RaySampling> sampling = renderer_.sampling(*other);
    if (!sampling || sampling->spacing == sampling_->spacing) {
      other = nextFiner(renderer_, scene_);
      if (other) sampling = renderer_.sampling(*other);
    }
    if (other) others_.push_back({*other, errorOverDifference(sampling->spacing / sampling_->spacing, *sampling_)});
  }

  // Light at every voxel is compared with light at every second one, and the other way round, unless there is no
  // memory for more than the latter: then the light's own estimate has to do.
  void compareLight(const RenderStats& first) {
    if (scene_.occlusion.ordinates.lightSpacing == 0 && first.lightSpacing == 2) {
      lightError_ = first.lightSpacingError;
      return;
    }
    const bool everyVoxel = first.lightSpacing == 1;
    ResolvedScene other = scene_;
    other.occlusion.ordinates.lightSpacing = everyVoxel ? 2 : 1;
    others_.push_back({std::move(other), errorOverDifference(everyVoxel ? 2 : 0.5, kLightOrders)});
  }

  // Returns how far the pictures are from those of another scene. The part of the difference that is there by chance,
  // as the streams' spread tells, does not count.
  double differenceTo(const Comparison& other) const {
    return rootMean(all_.values(), [&](std::size_t i) {
      const StreamMoments moments =
          momentsOf([&](std::size_t k) { return double{other.pictures[k].pixels[i]} - means_[k][i]; });
      return moments.mean * moments.mean - moments.variance;
    });
  }

  double standardError() const {
    return rootMean(all_.values(),
                    [&](std::size_t i) { return momentsOf([&](std::size_t k) { return means_[k][i]; }).variance; });
  }

  Renderer& renderer_;
  ResolvedScene scene_;
  bool pixelArea_;
  std::optional<RaySampling> sampling_;
  std::vector<Comparison> others_;  // until their differences are known
  double lightError_ = 0;           // of light at every second voxel that is compared with no other light
  std::vector<Stream> streams_;
  std::array<ColourMean, kStreams> means_;
  PictureMean all_;
  int passes_ = 0;
};

// Gives a renderer the scene again that it had.
class SceneKeeper {
 public:
  explicit SceneKeeper(Renderer& renderer) : renderer_(renderer), scene_(renderer.scene()) {}
  ~SceneKeeper() {
    try {
      renderer_.setScene(scene_);
    } catch (const std::exception&) {
      // What ends the series is told; a renderer that cannot take its old scene again keeps the last one.
    }
  }
  SceneKeeper(const SceneKeeper&) = delete;
  SceneKeeper& operator=(const SceneKeeper&) = delete;

 private:
  Renderer& renderer_;
  ResolvedScene scene_;
};

}  // namespace

ProgressivePicture renderProgressive(Renderer& renderer, const ProgressiveOptions& options,
                                     const std::function<bool(const ProgressivePicture&)>& onPass) {
  const ResolvedScene scene = renderer.scene();
  check(scene, options);
  const SceneKeeper keeper(renderer);
  const Stopwatch watch;
  auto series = std::make_unique<PassSeries>(renderer, scene, options);
  ProgressivePicture best{.scene = scene}, current{.scene = scene};
  bool refined = false;
  double systematicBefore = kInfinity;  // the systematic error of the coarser scene
  best.error = current.error = {kInfinity, kInfinity};
  for (int pass = 0; pass < options.passes; ++pass) {
    series->pass(current.picture, current.error);
    ++current.passes;
    current.scene = refined ? series->scene() : scene;
    current.seconds = watch.elapsedMs() / 1e3;
    current.reachedTarget = options.targetError > 0 && current.error.total() <= options.targetError;
    // A refined scene replaces the one before once it is known to be better.
    const bool sameScene = best.passes == 0 || best.scene.sampling.spacing == current.scene.sampling.spacing;
    const bool better = current.error.total() < best.error.total() ||
                        (current.passes >= best.passes && current.error.systematic < best.error.systematic);
    if (sameScene || better) best = current;
    best.seconds = current.seconds;
    if (onPass && !onPass(best)) break;
    if (best.reachedTarget || (options.maxSeconds > 0 && best.seconds >= options.maxSeconds)) break;
    if (options.targetError == 0 || current.passes < kStreams) continue;
    // Either kind of error may take half of the squared target. Waiting does not help where the error that does not
    // average out takes more.
    const bool inTheWay = !(current.error.systematic <= options.targetError / std::sqrt(2.0));
    std::optional<ResolvedScene> finer;
    if (options.refine && current.error.systematic <= systematicBefore) finer = nextFiner(renderer, series->scene());
    if (inTheWay && finer && pass + kStreams < options.passes) {
      series = std::make_unique<PassSeries>(renderer, *finer, options);
      systematicBefore = current.error.systematic;
      refined = true;
      current.passes = 0;
      current.error = {kInfinity, kInfinity};
    } else if (options.refine && !finer && !(current.error.systematic < options.targetError)) {
      break;  // and nothing is left to make it smaller
    }
  }
  return best;
}

}  // namespace umbrick
