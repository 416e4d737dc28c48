// SPDX-License-Identifier: Apache-2.0
#include "grid/sparse_rule.h"

#include <bit>
#include <cmath>
#include <limits>
#include <sstream>

#include "umbrick/core/error.h"
#include "umbrick/core/range.h"

namespace umbrick {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::string text(float value) {
  std::ostringstream out;
  out.precision(9);
  out << value;
  return out.str();
}

double difference(float a, float b) { return std::abs(static_cast<double>(a) - static_cast<double>(b)); }

float roundedToHalf(float value) { return static_cast<float>(openvdb::math::half(value)); }

void checkNotNegative(const std::string& name, const char* field, float value) {
  if (!(value >= 0) || !std::isfinite(value))
    throw InvalidArgument(name + ": " + field + ": expected 0 or more, found " + text(value));
}

}  // namespace

void SparseTally::add(const SparseTally& other) {
  leftOut.add(other.leftOut);
  merged.add(other.merged);
  rounded.add(other.rounded);
  clipped += other.clipped;
  maxClipChange = std::max(maxClipChange, other.maxClipChange);
  nonFinite += other.nonFinite;
  if (!tooLarge) tooLarge = other.tooLarge;
}

SparseRule::SparseRule(const std::string& name, const BuildOptions& options, float background, bool ofGrid)
    : background_(options.background.value_or(background)),
      tolerance_(options.maxError.value_or(options.tolerance)),
      clipBelow_(options.clipBelow.value_or(-kInfinity)),
      clipAbove_(options.clipAbove.value_or(kInfinity)),
      step_(options.maxError ? 0 : options.step),
      half_(!options.maxError && options.half),
      merges_(!options.maxError),
      keepsBackground_(ofGrid && tolerance_ == 0),
      plain_(tolerance_ == 0 && clipBelow_ == -kInfinity && clipAbove_ == kInfinity && !rounds()) {
  if (!std::isfinite(background_))
    throw InvalidArgument(name + ": background: expected a finite number, found " + text(background_));
  checkNotNegative(name, options.maxError ? "maximum error" : "tolerance", tolerance_);
  checkNotNegative(name, "step", step_);
  if (std::isnan(clipBelow_)) throw InvalidArgument(name + ": clip below: expected a number, found nan");
  if (std::isnan(clipAbove_)) throw InvalidArgument(name + ": clip above: expected a number, found nan");
  const float kept = storedInactive(background_);
  if (!std::isfinite(kept)) {
    SparseTally tally;
    tally.tooLarge = background_;
    checkTally(name, tally);
  }
  background_ = kept;
}

float SparseRule::storedInactive(float value) const { return half_ ? roundedToHalf(value) : value; }

float SparseRule::stored(float value) const {
  if (step_ > 0) {
    const double step = step_;
    value = static_cast<float>(step * std::nearbyint(static_cast<double>(value) / step));
  }
  return storedInactive(value);
}

bool SparseRule::apply(float& value, std::uint64_t voxels, SparseTally& tally) const {
  const float source = value;
  if (!std::isfinite(source)) {
    tally.nonFinite += voxels;
    value = background_;
    return false;
  }
  const double toBackground = difference(source, background_);
  if (source < clipBelow_ || source > clipAbove_) {
    value = background_;
    if (toBackground > 0) tally.clipped += voxels;
    tally.maxClipChange = std::max(tally.maxClipChange, toBackground);
    return false;
  }
  if (toBackground <= static_cast<double>(tolerance_) && !keepsBackground_) {
    value = background_;
    tally.leftOut.add(toBackground, static_cast<double>(voxels));
    return false;
  }
  value = stored(source);
  if (!std::isfinite(value)) tally.tooLarge = source;
  tally.rounded.add(difference(source, value), static_cast<double>(voxels));
  return true;
}

// Makes the mask of voxels that differ from the background, a word of 64 voxels at a time.
// @return false when some voxel is not finite; then nothing is changed
bool SparseRule::keepAll(LeafVoxels& leaf) const {
  constexpr std::uint32_t kExponent = 0x7f800000;
  std::uint32_t notFinite = 0;
  for (const float value : leaf.value) notFinite |= (std::bit_cast<std::uint32_t>(value) & kExponent) == kExponent;
  if (notFinite) return false;
  if (keepsBackground_) return true;
  for (openvdb::Index word = 0; word < Leaf::SIZE / 64; ++word) {
    const float* values = leaf.value + 64 * word;
    std::uint64_t differs = 0;
    for (int i = 0; i < 64; ++i) differs |= static_cast<std::uint64_t>(values[i] != background_) << i;
    leaf.active.getWord<std::uint64_t>(word) &= differs;
  }
  return true;
}

std::optional<float> SparseRule::apply(LeafVoxels& leaf, SparseTally& tally) const {
  if (plain_ && keepAll(leaf)) {
    if (!leaf.active.isOn()) return std::nullopt;
    const auto [low, high] = std::minmax_element(std::begin(leaf.value), std::end(leaf.value));
    return *low == *high ? std::optional(*low) : std::nullopt;
  }
  SparseTally own;
  float source[Leaf::SIZE];
  Range range, kept;
  for (auto voxel = leaf.active.beginOn(); voxel; ++voxel) {
    float& value = leaf.value[voxel.pos()];
    source[voxel.pos()] = value;
    range.include(value);
    if (apply(value, 1, own))
      kept.include(value);
    else
      leaf.active.setOff(voxel.pos());
  }
  std::optional<float> tile;
  if (leaf.active.isOn() && !own.tooLarge) {
    if (kept.min == kept.max) {
      tile = kept.min;
    } else if (tolerance_ > 0 && merges_) {
      // The tile is half way between the extremes, where the largest error of one value is the smallest.
      const float middle = stored(static_cast<float>(0.5 * (static_cast<double>(range.min) + range.max)));
      const double error = std::max(difference(range.min, middle), difference(range.max, middle));
      if (error <= static_cast<double>(tolerance_)) {
        tile = middle;
        own.rounded = {};
        for (const float value : source) own.merged.add(difference(value, middle));
      }
    }
  }
  tally.add(own);
  return tile;
}

void checkTally(const std::string& name, const SparseTally& tally) {
  if (tally.tooLarge)
    throw InvalidArgument(name + ": half floats: expected values up to 65504 in magnitude, found " +
                          text(*tally.tooLarge));
}

}  // namespace umbrick
