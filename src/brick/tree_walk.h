// Visits the leaves and tiles of an OpenVDB tree that overlap a box, each once, without a look-up per voxel.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "umbrick/grid/float_grid.h"

namespace umbrick {

using FloatTree = openvdb::FloatTree;
using FloatLeaf = FloatTree::LeafNodeType;

/// Cuts `box` along the multiples of `edge`, a power of two. The counters have 64 bits, since a box may end at the last
/// 32-bit coordinate.
template <class Visit>
void forEachBlock(const openvdb::CoordBBox& box, std::int64_t edge, const Visit& visit) {
  using openvdb::Coord;
  const auto lastOf = [&](std::int64_t i, int axis) {
    return static_cast<int>(std::min<std::int64_t>(i | (edge - 1), box.max()[axis]));
  };
  for (std::int64_t x = box.min().x(); x <= box.max().x(); x = (x | (edge - 1)) + 1)
    for (std::int64_t y = box.min().y(); y <= box.max().y(); y = (y | (edge - 1)) + 1)
      for (std::int64_t z = box.min().z(); z <= box.max().z(); z = (z | (edge - 1)) + 1)
        visit(openvdb::CoordBBox(Coord(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)),
                                 Coord(lastOf(x, 0), lastOf(y, 1), lastOf(z, 2))));
}

template <class Leaf, class Tile>
void walkNode(const FloatLeaf& node, const openvdb::CoordBBox& box, const Leaf& leaf, const Tile&) {
  leaf(node, box);
}

template <class Node, class Leaf, class Tile>
void walkNode(const Node& node, const openvdb::CoordBBox& box, const Leaf& leaf, const Tile& tile) {
  forEachBlock(box, Node::ChildNodeType::DIM, [&](const openvdb::CoordBBox& part) {
    const openvdb::Index slot = Node::coordToOffset(part.min());
    if (node.isChildMaskOn(slot))
      walkNode(*node.getTable()[slot].getChild(), part, leaf, tile);
    else
      tile(node.getTable()[slot].getValue(), part);
  });
}

/// Calls leaf(const FloatLeaf&, part) or tile(float, part) for parts that together are `box`. What no node covers is a
/// tile of the background.
template <class Leaf, class Tile>
void walkTree(const FloatTree& tree, const openvdb::CoordBBox& box, const Leaf& leaf, const Tile& tile) {
  using Upper = FloatTree::RootNodeType::ChildNodeType;
  forEachBlock(box, Upper::DIM, [&](const openvdb::CoordBBox& part) {
    if (const Upper* node = tree.root().probeConstNode<Upper>(part.min()))
      walkNode(*node, part, leaf, tile);
    else
      tile(tree.root().getValue(part.min()), part);
  });
}

}  // namespace umbrick
