// What values of a tree lose as they are changed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openvdb/openvdb.h>
#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>

#include "umbrick/grid/build_grid.h"

namespace umbrick {

/// What one value loses.
struct ValueLoss {
  double max = 0, squares = 0;  // grid units
};

/// Adds up what the values in leaves and in active tiles lose.
/// @param lost  of a value: ValueLoss
template <class Tree, class Lost>
QuantiseError lossOf(const Tree& tree, const Lost& lost) {
  const openvdb::tree::LeafManager<const Tree> leaves(tree);
  QuantiseError error = tbb::parallel_deterministic_reduce(
      leaves.leafRange(64), QuantiseError{},
      [&](const auto& range, QuantiseError sum) {
        for (auto leaf = range.begin(); leaf; ++leaf)
          for (openvdb::Index i = 0; i < Tree::LeafNodeType::SIZE; ++i) {
            const ValueLoss one = lost(leaf->getValue(i));
            sum.max = std::max(sum.max, one.max);
            sum.squares += one.squares;
            if (leaf->isValueOn(i)) sum.activeSquares += one.squares;
          }
        return sum;
      },
      [](QuantiseError a, const QuantiseError& b) {
        return QuantiseError{std::max(a.max, b.max), a.squares + b.squares, a.activeSquares + b.activeSquares};
      });
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    const ValueLoss one = lost(*tile);
    const double squares = one.squares * static_cast<double>(tile.getVoxelCount());
    error = {std::max(error.max, one.max), error.squares + squares, error.activeSquares + squares};
  }
  return error;
}

}  // namespace umbrick
