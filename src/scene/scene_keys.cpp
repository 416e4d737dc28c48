// SPDX-License-Identifier: Apache-2.0
#include "umbrick/scene/scene_keys.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>

#include "scene/key_tracks.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/scene.h"

namespace umbrick {
namespace {

// A number of a track at its keys.
struct Curve {
  const std::vector<SceneTrack::Key>& keys;
  std::size_t component;

  double value(std::size_t key) const { return keys[key].numbers[component]; }
  double length(std::size_t piece) const { return keys[piece + 1].frame - keys[piece].frame; }
  double slope(std::size_t piece) const { return (value(piece + 1) - value(piece)) / length(piece); }
  bool isEnd(std::size_t key) const { return key == 0 || key + 1 == keys.size(); }
};

// The speed at a key with which the curve stays between the keys, Fritsch and Butland 1984.
double monotoneSpeed(const Curve& curve, std::size_t key) {
  if (curve.isEnd(key)) return 0;
  const double before = curve.slope(key - 1), after = curve.slope(key);
  if (before * after <= 0) return 0;
  const double shorter = curve.length(key - 1), longer = curve.length(key);
  return 3 * (shorter + longer) / ((2 * longer + shorter) / before + (longer + 2 * shorter) / after);
}

// The speed at a key of the parabola through it and its neighbours.
double parabolaSpeed(const Curve& curve, std::size_t key) {
  if (curve.isEnd(key)) return 0;
  const double before = curve.length(key - 1), after = curve.length(key);
  return (after * curve.slope(key - 1) + before * curve.slope(key)) / (before + after);
}

// The cubic piece between a key and the next one. @param share  of the piece, in [0, 1]
double hermite(const Curve& curve, std::size_t piece, double share, double speed, double nextSpeed) {
  const double t = share, length = curve.length(piece), rise = curve.value(piece + 1) - curve.value(piece);
  return curve.value(piece) + t * (length * speed + t * (3 * rise - length * (2 * speed + nextSpeed) +
                                                         t * (length * (speed + nextSpeed) - 2 * rise)));
}

double between(const SceneTrack& track, std::size_t component, std::size_t piece, double share) {
  const Curve curve{track.keys, component};
  const double from = curve.value(piece), to = curve.value(piece + 1);
  if (track.curve == KeyCurve::linear) return from + share * (to - from);
  const bool place = track.field == "camera.eye" || track.field == "camera.lookAt";
  const auto speed = place ? parabolaSpeed : monotoneSpeed;
  const double value = hermite(curve, piece, share, speed(curve, piece), speed(curve, piece + 1));
  // Rounding may leave the range of the keys, which monotone pieces keep to.
  return place ? value : std::clamp(value, std::min(from, to), std::max(from, to));
}

// Where a frame lies among keys.
struct KeyPlace {
  std::size_t piece = 0;
  double share = 0;  // of the piece; 0: at the key itself
};

KeyPlace placeOf(const std::vector<SceneTrack::Key>& keys, double frame) {
  const auto after =
      std::upper_bound(keys.begin(), keys.end(), frame, [](double at, const auto& key) { return at < key.frame; });
  if (after == keys.begin()) return {};
  const auto piece = static_cast<std::size_t>(std::distance(keys.begin(), after)) - 1;
  if (after == keys.end()) return {piece, 0};
  return {piece, (frame - keys[piece].frame) / (keys[piece + 1].frame - keys[piece].frame)};
}

SceneTrack::Key at(const SceneTrack& track, double frame) {
  const auto [piece, share] = placeOf(track.keys, frame);
  if (share == 0) return track.keys[piece];
  SceneTrack::Key result{.frame = frame};
  for (std::size_t i = 0; i < track.keys[piece].numbers.size(); ++i)
    result.numbers.push_back(between(track, i, piece, share));
  if (const auto& first = track.keys[piece].transfer)
    result.transfer = mixed(*first, *track.keys[piece + 1].transfer,
                            track.curve == KeyCurve::linear ? share : share * share * (3 - 2 * share));
  return result;
}

Medium mixedMedia(const Medium& a, const Medium& b, double share) {
  Medium medium{.albedo = a.albedo + share * (b.albedo - a.albedo),
                .sigma_t = a.sigma_t + share * (b.sigma_t - a.sigma_t)};
  if (const double first = (1 - share) * a.sigma_t, second = share * b.sigma_t; first + second > 0) {
    const double weight = second / (first + second);
    medium.albedo = glm::clamp(a.albedo + weight * (b.albedo - a.albedo), 0.0, 1.0);
  }
  return medium;
}

// The medium that a 1D function tends to from below.
Medium fromBelow(const TransferFunction& transfer, double value) {
  const std::vector<double>& values = transfer.values();
  const auto at = std::lower_bound(values.begin(), values.end(), value);
  if (at == values.end() || *at != value) return transfer(value);
  return transfer.media()[static_cast<std::size_t>(std::distance(values.begin(), at))];
}

bool hasStep(const TransferFunction& transfer, double value) {
  const auto [first, last] = std::equal_range(transfer.values().begin(), transfer.values().end(), value);
  return std::distance(first, last) > 1;
}

}  // namespace

TransferFunction mixed(const TransferFunction& first, const TransferFunction& second, double share) {
  if (share <= 0 || first == second) return first;
  if (share >= 1) return second;
  if (first.is2d() != second.is2d())
    throw InvalidArgument("transfer: a function of the value alone and one of value and gradient cannot be mixed");
  if (first.is2d()) {
    if (first.values() != second.values() || first.gradients() != second.gradients())
      throw InvalidArgument("transfer: functions of value and gradient can be mixed on one lattice, found two");
    std::vector<Medium> media;
    for (std::size_t i = 0; i < first.media().size(); ++i)
      media.push_back(mixedMedia(first.media()[i], second.media()[i], share));
    return TransferFunction(first.values(), first.gradients(), std::move(media)).withUnit(first.unit());
  }
  std::vector<double> values;
  std::set_union(first.values().begin(), first.values().end(), second.values().begin(), second.values().end(),
                 std::back_inserter(values));
  values.erase(std::unique(values.begin(), values.end()), values.end());
  std::vector<TransferFunction::Point> points;
  for (const double value : values) {
    if (hasStep(first, value) || hasStep(second, value))
      points.push_back({value, mixedMedia(fromBelow(first, value), fromBelow(second, value), share)});
    points.push_back({value, mixedMedia(first(value), second(value), share)});
  }
  return TransferFunction(std::move(points)).withUnit(first.unit());
}

Scene sceneAt(const Scene& scene, double frame) {
  Scene result = scene;
  for (const SceneTrack& track : scene.tracks) {
    const SceneTrack::Key key = at(track, frame);
    if (key.transfer)
      result.transfer = key.transfer;
    else
      setNumbers(result, track.field, key.numbers);
    if (track.field == "camera.up")
      if (const double length = glm::length(result.camera.up); length > 0) result.camera.up /= length;
  }
  return result;
}

bool dropKeys(Scene& scene, std::string_view field) {
  return std::erase_if(scene.tracks, [&](const SceneTrack& track) { return track.field == field; }) > 0;
}

}  // namespace umbrick
