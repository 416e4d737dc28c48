// What becomes of one voxel, and of one leaf of voxels, when a volume is made sparse.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {

using Leaf = openvdb::FloatTree::LeafNodeType;
inline constexpr std::int64_t kLeafEdge = Leaf::DIM;  // 8 voxels

/// Errors of some voxels.
struct LossSum {
  double max = 0, squares = 0;
  void add(double error, double voxels = 1) {
    max = std::max(max, error);
    squares += voxels * error * error;
  }
  void add(const LossSum& other) {
    max = std::max(max, other.max);
    squares += other.squares;
  }
};

/// Of so many voxels; 0 of none.
inline double rootMean(double squares, std::uint64_t voxels) {
  return voxels > 0 ? std::sqrt(squares / static_cast<double>(voxels)) : 0.0;
}

/// The losses of some voxels; tallies add up in any order, squares up to rounding.
struct SparseTally {
  LossSum leftOut, merged, rounded;  // within the tolerance of the background, or of a tile; by step and half
  std::uint64_t clipped = 0;
  double maxClipChange = 0;
  std::uint64_t nonFinite = 0;
  std::optional<float> tooLarge;  // a value that half floats cannot hold
  void add(const SparseTally& other);
};

/// 512 voxels in the order of a leaf: z fastest.
struct LeafVoxels {
  float value[Leaf::SIZE];
  Leaf::NodeMaskType active;  // in: which to look at; out: which stay active
};

class SparseRule {
 public:
  /// With options.maxError only what lies that close to the background is left out: how the rest is stored is chosen
  /// when its values are known, see storageWithin.
  /// @param background  used when the options give none
  /// @throw InvalidArgument
  SparseRule(const std::string& name, const BuildOptions& options, float background);

  float background() const { return background_; }
  bool half() const { return half_; }
  bool rounds() const { return half_ || step_ > 0; }
  /// The value as it is stored where it is active.
  float stored(float value) const;
  /// The value as it is stored where it is not: steps are for what is active.
  float storedInactive(float value) const;
  /// @return false when the voxel becomes background; `value` becomes what is stored
  /// @param voxels  how many it stands for
  bool apply(float& value, std::uint64_t voxels, SparseTally& tally) const;
  /// Applies the rule to the active voxels.
  /// @return the value of a tile that may stand for the leaf, when all its voxels are active and close enough
  std::optional<float> apply(LeafVoxels& leaf, SparseTally& tally) const;

 private:
  bool keepAll(LeafVoxels& leaf) const;

  float background_, tolerance_, clipBelow_, clipAbove_, step_;
  bool half_, merges_;
  bool plain_;  // nothing is changed but what is not finite
};

/// What honours options.maxError for the active values of a tree: the options with half, step and tolerance in its
/// place.
BuildOptions storageWithin(const openvdb::FloatTree& tree, const BuildOptions& options);

/// Applies the rule to the active voxels and tiles of a tree.
SparseTally sparsifyTree(openvdb::FloatTree& tree, const SparseRule& rule);

/// @throw InvalidArgument  when the tally met a value too large for half floats
void checkTally(const std::string& name, const SparseTally& tally);

/// "float" or "half", with ", steps of ..." behind it.
std::string storageText(const BuildOptions& options);

/// Fills in what the grid holds and what the tally lost, in the report and in the metadata of the grid.
/// @param report  its voxels, conversionError and backgroundChange are set
void describe(openvdb::FloatGrid& grid, const SparseTally& tally, const BuildOptions& options, BuildReport& report);

}  // namespace umbrick
