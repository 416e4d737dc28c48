#include "grid/sparse_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "umbrick/core/error.h"
#include "umbrick/core/range.h"

namespace umbrick {
namespace {

std::string text(float value) {
  std::ostringstream out;
  out.precision(9);
  out << value;
  return out.str();
}

double difference(float a, float b) { return std::abs(static_cast<double>(a) - static_cast<double>(b)); }

}  // namespace

void SparseTally::add(const SparseTally& other) {
  maxError = std::max(maxError, other.maxError);
  clipped += other.clipped;
  maxClipChange = std::max(maxClipChange, other.maxClipChange);
  nonFinite += other.nonFinite;
  if (!tooLarge) tooLarge = other.tooLarge;
}

SparseRule::SparseRule(const std::string& name, const BuildOptions& options, float background)
    : background_(options.background.value_or(background)),
      tolerance_(options.tolerance),
      clipBelow_(options.clipBelow.value_or(-std::numeric_limits<float>::infinity())),
      half_(options.half) {
  if (!std::isfinite(background_))
    throw InvalidArgument(name + ": background: expected a finite number, found " + text(background_));
  if (!(tolerance_ >= 0) || !std::isfinite(tolerance_))
    throw InvalidArgument(name + ": tolerance: expected 0 or more, found " + text(tolerance_));
  if (std::isnan(clipBelow_)) throw InvalidArgument(name + ": clip below: expected a number, found nan");
  const float rounded = stored(background_);
  if (!std::isfinite(rounded)) checkTally(name, {0, 0, 0, 0, background_});
  background_ = rounded;
}

float SparseRule::stored(float value) const { return half_ ? static_cast<float>(openvdb::math::half(value)) : value; }

bool SparseRule::apply(float& value, std::uint64_t voxels, SparseTally& tally) const {
  const float source = value;
  if (!std::isfinite(source)) {
    tally.nonFinite += voxels;
    value = background_;
    return false;
  }
  const double toBackground = difference(source, background_);
  if (source < clipBelow_) {
    value = background_;
    if (toBackground > 0) tally.clipped += voxels;
    tally.maxClipChange = std::max(tally.maxClipChange, toBackground);
    return false;
  }
  if (toBackground <= static_cast<double>(tolerance_)) {
    value = background_;
    tally.maxError = std::max(tally.maxError, toBackground);
    return false;
  }
  value = stored(source);
  if (half_ && !std::isfinite(value)) tally.tooLarge = source;
  tally.maxError = std::max(tally.maxError, difference(source, value));
  return true;
}

std::optional<float> SparseRule::apply(LeafVoxels& leaf, SparseTally& tally) const {
  SparseTally own;
  Range source, kept;
  for (auto voxel = leaf.active.beginOn(); voxel; ++voxel) {
    float& value = leaf.value[voxel.pos()];
    source.include(value);
    if (apply(value, 1, own))
      kept.include(value);
    else
      leaf.active.setOff(voxel.pos());
  }
  std::optional<float> tile;
  if (leaf.active.isOn() && !own.tooLarge) {
    if (kept.min == kept.max) {
      tile = kept.min;
    } else if (tolerance_ > 0) {
      // Half way between the extremes, so that the error is the smallest that one value can have.
      const float middle = stored(static_cast<float>(0.5 * (static_cast<double>(source.min) + source.max)));
      const double error = std::max(difference(source.min, middle), difference(source.max, middle));
      if (error <= static_cast<double>(tolerance_)) {
        tile = middle;
        own.maxError = error;
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

void describe(const openvdb::FloatTree& tree, const SparseTally& tally, BuildReport& report) {
  report.activeVoxels = tree.activeVoxelCount();
  report.activeTiles = tree.activeTileCount();
  report.leaves = tree.leafCount();
  report.maxError = tally.maxError;
  report.clippedVoxels = tally.clipped;
  report.maxClipChange = tally.maxClipChange;
  report.nonFinite = tally.nonFinite;
}

}  // namespace umbrick
