// What becomes of one voxel, and of one leaf of voxels, when a volume is made sparse.
#pragma once

#include <optional>
#include <string>

#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {

using Leaf = openvdb::FloatTree::LeafNodeType;

/// The losses of some voxels; tallies add up in any order.
struct SparseTally {
  double maxError = 0;
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
  /// @param background  used when the options give none
  /// @throw InvalidArgument
  SparseRule(const std::string& name, const BuildOptions& options, float background);

  float background() const { return background_; }
  bool half() const { return half_; }
  /// The value as it is stored.
  float stored(float value) const;
  /// @return false when the voxel becomes background; `value` becomes what is stored
  /// @param voxels  how many it stands for
  bool apply(float& value, std::uint64_t voxels, SparseTally& tally) const;
  /// Applies the rule to the active voxels.
  /// @return the value of a tile that may stand for the leaf, when all its voxels are active and close enough
  std::optional<float> apply(LeafVoxels& leaf, SparseTally& tally) const;

 private:
  float background_, tolerance_, clipBelow_;
  bool half_;
};

/// @throw InvalidArgument  when the tally met a value too large for half floats
void checkTally(const std::string& name, const SparseTally& tally);

/// Fills in what the tree holds and what the tally lost.
void describe(const openvdb::FloatTree& tree, const SparseTally& tally, BuildReport& report);

}  // namespace umbrick
