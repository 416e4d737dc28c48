// All values of a grid replaced, one by one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openvdb/openvdb.h>
#include <openvdb/tree/LeafManager.h>

namespace umbrick {

/// Replaces each value of a tree by change(value): of voxels and tiles, active or not, and the background. What is
/// active stays so. Leaves are changed on all cores.
template <class Tree, class Change>
void changeValues(Tree& tree, const Change& change) {
  using LeafNode = typename Tree::LeafNodeType;
  openvdb::tree::LeafManager<Tree> leaves(tree);
  leaves.foreach ([&](LeafNode& leaf, std::size_t) {
    for (openvdb::Index i = 0; i < LeafNode::SIZE; ++i) leaf.setValueOnly(i, change(leaf.getValue(i)));
  });
  auto tile = tree.beginValueAll();
  tile.setMaxDepth(Tree::ValueAllIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    const bool active = tile.isValueOn();
    tile.setValue(change(*tile));
    tile.setActiveState(active);
  }
  tree.root().setBackground(change(tree.background()), /*updateChildNodes=*/false);
}

}  // namespace umbrick
