// SPDX-License-Identifier: Apache-2.0
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>

#include "grid/sparse_rule.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {
namespace {

using openvdb::FloatTree;

SparseTally joined(SparseTally a, const SparseTally& b) {
  a.add(b);
  return a;
}

SparseTally sparsifyLeaves(FloatTree& tree, const SparseRule& rule) {
  openvdb::tree::LeafManager<FloatTree> leaves(tree);
  std::vector<std::optional<float>> tiles(leaves.leafCount());
  const SparseTally tally = tbb::parallel_deterministic_reduce(
      leaves.leafRange(64), SparseTally{},
      [&](const auto& range, SparseTally sum) {
        for (auto leaf = range.begin(); leaf; ++leaf) {
          LeafVoxels voxels;
          std::copy_n(leaf->buffer().data(), Leaf::SIZE, voxels.value);
          voxels.active = leaf->valueMask();
          tiles[leaf.pos()] = rule.apply(voxels, sum);
          std::copy_n(voxels.value, Leaf::SIZE, leaf->buffer().data());
          leaf->setValueMask(voxels.active);
        }
        return sum;
      },
      joined);
  std::vector<std::pair<openvdb::Coord, float>> places;
  for (std::size_t i = 0; i < tiles.size(); ++i)
    if (tiles[i]) places.emplace_back(leaves.leaf(i).origin(), *tiles[i]);
  for (const auto& [origin, value] : places) tree.addTile(1, origin, value, true);
  return tally;
}

SparseTally sparsifyTiles(FloatTree& tree, const SparseRule& rule) {
  SparseTally tally;
  auto tile = tree.beginValueOn();
  tile.setMaxDepth(FloatTree::ValueOnIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    float value = *tile;
    const bool keep = rule.apply(value, tile.getVoxelCount(), tally);
    tile.setValue(value);
    if (!keep) tile.setActiveState(false);
  }
  return tally;
}

// Rounds values to how they are stored and tallies the loss. It takes all values, or with `onlyInactive` just the
// inactive ones, where the others have been rounded already. The mean is over active voxels, so inactive ones count for
// the maximum only.
SparseTally roundValues(FloatTree& tree, const SparseRule& rule, bool onlyInactive) {
  const auto round = [&](float value, bool active, double voxels, SparseTally& tally) {
    const float stored = active ? rule.stored(value) : rule.storedInactive(value);
    if (std::isfinite(value) && !std::isfinite(stored)) tally.tooLarge = value;
    if (std::isfinite(value)) tally.rounded.add(std::abs(double(value) - double(stored)), active ? voxels : 0);
    return stored;
  };
  openvdb::tree::LeafManager<FloatTree> leaves(tree);
  SparseTally tally = tbb::parallel_deterministic_reduce(
      leaves.leafRange(64), SparseTally{},
      [&](const auto& range, SparseTally sum) {
        for (auto leaf = range.begin(); leaf; ++leaf)
          for (openvdb::Index i = 0; i < Leaf::SIZE; ++i)
            if (!onlyInactive || !leaf->isValueOn(i))
              leaf->setValueOnly(i, round(leaf->getValue(i), leaf->isValueOn(i), 1, sum));
        return sum;
      },
      joined);
  auto tile = tree.beginValueAll();
  tile.setMaxDepth(FloatTree::ValueAllIter::LEAF_DEPTH - 1);
  for (; tile; ++tile)
    if (!onlyInactive || !tile.isValueOn()) {
      const bool active = tile.isValueOn();
      tile.setValue(round(*tile, active, static_cast<double>(tile.getVoxelCount()), tally));
      tile.setActiveState(active);
    }
  tree.root().setBackground(round(tree.background(), false, 0, tally), /*updateChildNodes=*/false);
  return tally;
}

}  // namespace

SparseTally sparsifyTree(FloatTree& tree, const SparseRule& rule) {
  SparseTally tally = sparsifyTiles(tree, rule);
  tally.add(sparsifyLeaves(tree, rule));
  return tally;
}

BuiltGrid sparsifyGrid(const ScalarGrid& source, const BuildOptions& asked) {
  openvdb::initialize();
  BuildOptions options = asked;
  // A grid that is marked for half floats will be saved as such, so the report must contain what that costs.
  options.half = options.half || source.grid->saveFloatAsHalf();
  const std::string name = "grid \"" + source.name + '"';
  BuiltGrid built{source.grid->deepCopy(), {}};
  FloatTree& tree = built.grid->tree();
  built.report.voxels = tree.activeVoxelCount();
  built.report.conversionError = source.conversionError;
  const bool levelSet = built.grid->getGridClass() == openvdb::GRID_LEVEL_SET;
  const float oldBackground = tree.background();

  if (options.maxError) {
    const SparseRule checked(name, options, oldBackground, /*ofGrid=*/true);
    options = storageWithin(tree, options);
  }
  const SparseRule rule(name, options, oldBackground, /*ofGrid=*/true);
  SparseTally tally;
  if (!levelSet) {
    if (rule.background() != oldBackground) {
      openvdb::tools::changeBackground(tree, rule.background());
      built.report.backgroundChange = std::abs(double(rule.background()) - double(oldBackground));
    }
    tally.add(sparsifyTree(tree, rule));
  }
  if (rule.rounds()) tally.add(roundValues(tree, rule, /*onlyInactive=*/!levelSet));
  built.grid->setSaveFloatAsHalf(rule.half());
  checkTally(name, tally);
  openvdb::tools::prune(tree);

  describe(*built.grid, tally, options, built.report);
  return built;
}

}  // namespace umbrick
