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

/// The sum of the errors of some voxels.
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

/// Returns the root of the mean of so many squares; 0 for no voxels.
inline double rootMean(double squares, std::uint64_t voxels) {
  return voxels > 0 ? std::sqrt(squares / static_cast<double>(voxels)) : 0.0;
}

/// The losses of some voxels. Tallies may be added in any order; the sums of squares are then equal up to rounding.
struct SparseTally {
  // Losses of voxels close to the background; of voxels merged into a tile; by step and half.
  LossSum leftOut, merged, rounded;
  std::uint64_t clipped = 0;
  double maxClipChange = 0;
  std::uint64_t nonFinite = 0;
  std::optional<float> tooLarge;  // a value that half floats cannot hold, if there is one
  void add(const SparseTally& other);
};

/// The 512 voxels of a leaf in its own order: z fastest.
struct LeafVoxels {
  float value[Leaf::SIZE];
  Leaf::NodeMaskType active;  // before: which voxels to look at; after: which stay active
};

class SparseRule {
 public:
  /// With options.maxError, only what lies that close to the background is left out. How the rest is stored is chosen
  /// when its values are known, see storageWithin.
  /// @param background  used when the options give none
  /// @param ofGrid      the voxels are those of a grid, which says which of them are active: one that has just the
  ///                    background stays so, unless a tolerance asks for what is close to it
  /// @throw InvalidArgument  options that buildGrid refuses
  SparseRule(const std::string& name, const BuildOptions& options, float background, bool ofGrid = false);

  float background() const { return background_; }
  bool half() const { return half_; }
  bool rounds() const { return half_ || step_ > 0; }
  /// Returns an active value as it is stored.
  float stored(float value) const;
  /// Returns an inactive value as it is stored; it is not rounded to steps, which are for active values.
  float storedInactive(float value) const;
  /// Makes `value` what is stored.
  /// @param voxels  the number of voxels that it stands for
  /// @return false when the voxels become background
  bool apply(float& value, std::uint64_t voxels, SparseTally& tally) const;
  /// Applies the rule to the active voxels of a leaf.
  /// @return the value of a tile that may stand for the leaf, when all its voxels are active and close enough
  std::optional<float> apply(LeafVoxels& leaf, SparseTally& tally) const;

 private:
  bool keepAll(LeafVoxels& leaf) const;

  float background_, tolerance_, clipBelow_, clipAbove_, step_;
  bool half_, merges_;
  bool keepsBackground_;  // active voxels that have the background stay
  bool plain_;            // only values that are not finite are changed
};

/// Returns the options with half, step and tolerance in place of maxError, chosen so that no active value of the tree
/// is off by more.
BuildOptions storageWithin(const openvdb::FloatTree& tree, const BuildOptions& options);

/// Applies the rule to the active voxels and tiles of a tree.
SparseTally sparsifyTree(openvdb::FloatTree& tree, const SparseRule& rule);

/// @throw InvalidArgument  the tally met a value too large for half floats
void checkTally(const std::string& name, const SparseTally& tally);

/// Returns "float" or "half", with ", steps of ..." behind it where there are steps.
std::string storageText(const BuildOptions& options);

/// Writes what the grid holds and what the tally lost into the report and into the metadata of the grid.
/// @param report  has voxels, conversionError and backgroundChange set already
void describe(openvdb::FloatGrid& grid, const SparseTally& tally, const BuildOptions& options, BuildReport& report);

}  // namespace umbrick
