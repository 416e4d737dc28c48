// Looking at the active voxels of a grid, leaf by leaf by all cores, and at its active tiles.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cstddef>

#include "umbrick/grid/float_grid.h"

namespace umbrick {

using FloatLeaf = openvdb::FloatTree::LeafNodeType;
using FloatLeaves = openvdb::tree::LeafManager<const openvdb::FloatTree>;

/// Calls action(value, box) for each active tile.
template <class Action>
void visitTiles(const openvdb::FloatTree& tree, const Action& action) {
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(openvdb::FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) action(*tile, tile.getBoundingBox());
}

/// Calls look(leaf, state) for all leaves, with a state of its own for each part of them. The parts and the order in
/// which they are added are the same however many cores there are, so that sums are, too.
/// @return the sum of the states
template <class State, class Look>
State overLeaves(const FloatLeaves& leaves, const State& start, const Look& look) {
  constexpr std::size_t kParts = 64;
  return tbb::parallel_deterministic_reduce(
      leaves.leafRange(std::max<std::size_t>(1, leaves.leafCount() / kParts)), start,
      [&](const auto& range, State state) {
        for (auto leaf = range.begin(); leaf; ++leaf) look(*leaf, state);
        return state;
      },
      [](State a, const State& b) {
        a.add(b);
        return a;
      });
}

}  // namespace umbrick
