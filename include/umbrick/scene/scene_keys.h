// What of a scene changes over frames: the values that it has at key frames, and those between.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "umbrick/core/names.h"
#include "umbrick/optics/transfer_function.h"

namespace umbrick {
struct Scene;

/// How values run between keys. Before the first key and after the last one they stay.
///
/// `linear`: at constant speed from key to key.
///
/// `smooth`: without a jump of speed. They begin and end at rest. Numbers never leave the range of the two keys around
/// them (monotone cubic pieces, Fritsch and Carlson 1980, doi:10.1137/0717021, with the slopes of Fritsch and Butland
/// 1984, doi:10.1137/0905021), so that an angle or a radiance stays as valid as its keys are. The places camera.eye and
/// camera.lookAt run along curves that do not depend on the axes (cubic pieces, whose velocity at a key is that of the
/// parabola through the key and its two neighbours), which may swing wider than the keys. A transfer function is mixed
/// from the two keys around it, each of which it rests at.
enum class KeyCurve { smooth, linear };
inline constexpr Name<KeyCurve> kKeyCurves[]{{"smooth", KeyCurve::smooth}, {"linear", KeyCurve::linear}};

/// One thing of a scene that changes.
struct SceneTrack {
  struct Key {
    double frame = 0;
    std::vector<double> numbers = {};               // of the field in memory: angles are in radians
    std::optional<TransferFunction> transfer = {};  // of the track "transfer"
    bool operator==(const Key&) const = default;
  };
  /// The path of a scene field that is a number or a vector, or "clip.planes" (four numbers each), "clip.box" (two
  /// corners) or "transfer".
  std::string field;
  KeyCurve curve = KeyCurve::smooth;
  std::vector<Key> keys;  // at least one, frames ascending, all with as many numbers
  bool operator==(const SceneTrack&) const = default;
};

/// Returns the scene as it is at a frame: all that has keys has its values there. The up of the camera gets length 1
/// again. @throw InvalidArgument  a track of a field that the scene does not have
Scene sceneAt(const Scene& scene, double frame);

/// Removes the keys of a field, which then keeps the value that the scene has. @return whether there were any
bool dropKeys(Scene& scene, std::string_view field);

/// Mixes two 1D functions, or two 2D functions of the same lattice: at every value, albedo and sigma_t are linear in
/// the share. Albedos are weighted by their extinction, so that what is not there has no colour.
/// @param share  of the second one, in [0, 1]
/// @throw InvalidArgument  one has 1D and one 2D, or lattices differ
TransferFunction mixed(const TransferFunction& first, const TransferFunction& second, double share);

}  // namespace umbrick
