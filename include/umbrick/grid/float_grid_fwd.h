// The names of OpenVDB's tree and grid of floats, without their definitions: those are in float_grid.h, which takes
// several seconds to compile. A file that only hands grids on needs no more than this.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openvdb/version.h>

#include <cstdint>

namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {

template <typename>
class Grid;

namespace tree {
template <typename, std::uint32_t>
class LeafNode;
template <typename, std::uint32_t>
class InternalNode;
template <typename>
class RootNode;
template <typename>
class Tree;
}  // namespace tree

using FloatTree = tree::Tree<tree::RootNode<tree::InternalNode<tree::InternalNode<tree::LeafNode<float, 3>, 4>, 5>>>;
using FloatGrid = Grid<FloatTree>;

}  // namespace OPENVDB_VERSION_NAME
}  // namespace openvdb
