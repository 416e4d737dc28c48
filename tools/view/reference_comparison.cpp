// SPDX-License-Identifier: Apache-2.0
#include "view/reference_comparison.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "compare_report.h"
#include "umbrick/core/error.h"
#include "umbrick/core/printable.h"
#include "umbrick/core/short_number.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/image/colour_map.h"
#include "umbrick/image/image_difference.h"
#include "umbrick/reference/reference.h"
#include "view/base64.h"
#include "view/frame_encoder.h"
#include "view/sample_grid.h"

namespace umbrick::view {
namespace {

using Json = nlohmann::ordered_json;

// Coarser than umbrick reference takes by itself, since people wait for it: in a seventh of the time, and off by 0.0009
// (RMSE of RGB) on a head of CT.
constexpr int kDirections = 64;       // of light
constexpr double kTolerance = 1e-3;   // of the radiance
constexpr double kTellShareMs = 200;  // between two words on how far it is

// A picture that another thread draws.
struct Drawn {
  std::mutex mutex;
  std::condition_variable changed;
  std::optional<Image> picture;
  std::string failure;

  void finish(std::optional<Image> picture_, std::string failure_) {
    const std::lock_guard lock(mutex);
    picture = std::move(picture_);
    failure = std::move(failure_);
    changed.notify_all();
  }
};

// Returns the smallest of 1, 2 and 5 times powers of ten that is no smaller.
double roundedUp(double value) {
  if (!(value > 0) || !std::isfinite(value)) return 1e-6;
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0})
    if (value <= step * power * (1 + 1e-9)) return step * power;
  return 10 * power;
}

Json sizeOf(const Camera& camera) { return {camera.width, camera.height}; }

// One core is left to the picture that goes on.
int threadsBeside() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency()) - 1); }

}  // namespace

struct ReferenceComparison::Compared {
  std::shared_ptr<const Volume> volume;
  ResolvedScene scene;
  std::shared_ptr<Drawn> drawn;
};

ResolvedScene comparedScene(const ResolvedScene& scene) {
  ResolvedScene small = scene;
  const int longer = std::max(scene.camera.width, scene.camera.height);
  if (longer <= kComparedEdge) return small;
  const double scale = static_cast<double>(kComparedEdge) / longer;
  small.camera.width = std::max(1, static_cast<int>(std::lround(scene.camera.width * scale)));
  small.camera.height = std::max(1, static_cast<int>(std::lround(scene.camera.height * scale)));
  return small;
}

std::uint64_t referenceMemory(const Volume& volume, const ResolvedScene& scene) {
  // A block of 8^3 cells holds 9^3 floats, with a function of gradients as many again, and a byte for each cell.
  const std::uint64_t floats = 9 * 9 * 9 * sizeof(float) * (scene.transfer.is2d() ? 2 : 1);
  return (activeVoxels(volume.grid()) / (8 * 8 * 8) + 1) * (floats + 8 * 8 * 8);
}

Json comparisonOf(const Image& drawn, const Image& reference) {
  const ImageDifference difference = differenceOf(drawn, reference);
  const double top = roundedUp(difference.p999);
  Json measures = Json::array();
  for (const tools::Measure& measure : tools::kMeasures) {
    const std::optional<double> value = measure.of(difference);
    if (!value) continue;
    measures.push_back(
        {{"title", measure.title}, {"help", measure.help}, {"value", std::isfinite(*value) ? Json(*value) : Json()}});
  }
  return {{"state", "done"},
          {"size", {drawn.width, drawn.height}},
          {"text", "RMSE " + shortNumber(difference.rmseRgb.value_or(difference.rmse), 2) + " against the reference"},
          {"measures", measures},
          {"top", top},
          {"pictures",
           {{"drawn", base64(encodePng(drawn))},
            {"reference", base64(encodePng(reference))},
            {"difference", base64(encodePng(colourMapped(errorMap(drawn, reference), 0, top)))}}}};
}

ReferenceComparison::ReferenceComparison(std::function<void(std::uint64_t, const Json&)> tell)
    : tell_(std::move(tell)) {}

std::uint64_t ReferenceComparison::start(std::shared_ptr<const Volume> volume, const ResolvedScene& scene,
                                         ViewRenderer& renderer) {
  constexpr std::uint64_t kMiB = 1 << 20;
  const std::uint64_t needed = referenceMemory(*volume, scene) / kMiB;
  if (needed > scene.bricks.budgetMiB)
    throw InvalidArgument("compare: the reference would take about " + std::to_string(needed) +
                          " MiB, and bricks.budgetMiB is " + std::to_string(scene.bricks.budgetMiB));
  const auto drawn = std::make_shared<Drawn>();
  const auto compared = std::make_shared<Compared>(Compared{std::move(volume), comparedScene(scene), drawn});
  renderer.drawWhole(
      compared->scene, [drawn](const Picture& picture, const std::string&) { drawn->finish(picture.colour, {}); },
      [drawn](const std::string& failure) { drawn->finish({}, failure); });
  return job_.start([this, compared](std::uint64_t number) {
    try {
      compare(*compared, number);
    } catch (const std::exception& error) {
      tell_(number, {{"state", "none"}, {"text", asUtf8(error.what())}});
    }
  });
}

void ReferenceComparison::compare(const Compared& compared, std::uint64_t number) {
  const Stopwatch watch;
  double told = -kTellShareMs;
  ReferenceOptions options;
  options.threads = threadsBeside();
  options.directions = kDirections;
  options.tolerance = kTolerance;
  options.progress = [&](double share) {
    if (!isCurrent(number)) return false;
    if (watch.elapsedMs() - told >= kTellShareMs) {
      told = watch.elapsedMs();
      tell_(number, {{"state", "running"}, {"share", share}, {"size", sizeOf(compared.scene.camera)}});
    }
    return true;
  };
  const ReferencePicture reference = renderReference(compared.volume->grid(), compared.scene, options);
  if (!reference.complete) return;
  Drawn& drawn = *compared.drawn;
  std::unique_lock lock(drawn.mutex);
  // The thread that draws may end without a word when the program does.
  while (!drawn.picture && drawn.failure.empty()) {
    if (!isCurrent(number)) return;
    drawn.changed.wait_for(lock, std::chrono::milliseconds(50));
  }
  if (!drawn.picture) throw InvalidArgument(drawn.failure);
  Json result = comparisonOf(*drawn.picture, reference.colour);
  result["seconds"] = watch.elapsedMs() / 1000;
  tell_(number, result);
}

}  // namespace umbrick::view
