// The edges of a lattice along which values cross a limit.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "umbrick/grid/float_grid.h"

namespace umbrick {

/// Finds them from the end that has the value or more, so that each is found once. All values count, active or not; the
/// background, which is less, is outside.
class CrossingEdges {
 public:
  using Leaf = openvdb::FloatTree::LeafNodeType;

  CrossingEdges(const openvdb::FloatTree& field, float value) : field_(field), value_(value) {}

  /// Calls found(at, axis, side) for each edge that begins in the leaf: from voxel `at` to its neighbour on that side.
  template <class Found>
  void inLeaf(const Leaf& leaf, const Found& found) {
    const Bits inside = insideOf(leaf);
    if (std::all_of(inside.begin(), inside.end(), [](std::uint64_t word) { return word == 0; })) return;
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) {
        const Bits beside = neighboursOf(leaf, inside, axis, side);
        for (unsigned x = 0; x < inside.size(); ++x)
          for (std::uint64_t left = inside[x] & ~beside[x]; left != 0; left &= left - 1) {
            const auto bit = static_cast<unsigned>(std::countr_zero(left));
            found(leaf.offsetToGlobalCoord(64 * x + bit), axis, side);
          }
      }
  }

  /// Does the same for a tile, whose edges all begin in its faces.
  template <class Found>
  void inTile(const openvdb::CoordBBox& box, float here, const Found& found) {
    if (here < value_) return;
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) {
        openvdb::CoordBBox face = box;
        (side > 0 ? face.min() : face.max())[axis] = side > 0 ? box.max()[axis] : box.min()[axis];
        for (const openvdb::Coord& at : face)
          if (crosses(at, axis, side)) found(at, axis, side);
      }
  }

 private:
  static_assert(Leaf::DIM == 8, "a word holds the 64 voxels of one x, z fastest");
  using Bits = std::array<std::uint64_t, 8>;

  Bits insideOf(const Leaf& leaf) const {
    Bits bits{};
    const float* values = leaf.buffer().data();
    for (std::size_t x = 0; x < 8; ++x)
      for (std::size_t i = 0; i < 64; ++i) bits[x] |= std::uint64_t(values[64 * x + i] >= value_) << i;
    return bits;
  }

  // Whether the neighbours of the voxels of a leaf on one side are inside, at the places of those voxels.
  Bits neighboursOf(const Leaf& leaf, const Bits& inside, int axis, int side) const {
    openvdb::Coord origin = leaf.origin();
    origin[axis] += side * int(Leaf::DIM);
    const Leaf* next = field_.probeConstLeaf(origin);
    const bool tile = next == nullptr && field_.getValue(origin) >= value_;
    const auto isInside = [&](unsigned offset) {
      return std::uint64_t(next ? next->getValue(offset) >= value_ : tile);
    };
    Bits beside{};
    const unsigned face = side > 0 ? 0 : 7;  // of the leaf beside it
    constexpr std::uint64_t kLowZ = 0x0101010101010101, kHighZ = kLowZ << 7;
    for (unsigned x = 0; x < 8; ++x) {
      std::uint64_t outer = 0;  // voxels of the other leaf, where they are neighbours
      if (axis == 0) {
        const int at = int(x) + side;
        if (at >= 0 && at < 8) {
          beside[x] = inside[static_cast<std::size_t>(at)];
          continue;
        }
        for (unsigned i = 0; i < 64; ++i) outer |= isInside(64 * face + i) << i;
        beside[x] = outer;
      } else if (axis == 1) {
        for (unsigned z = 0; z < 8; ++z) outer |= isInside(64 * x + 8 * face + z) << (8 * (7 - face) + z);
        beside[x] = (side > 0 ? inside[x] >> 8 : inside[x] << 8) | outer;
      } else {
        for (unsigned y = 0; y < 8; ++y) outer |= isInside(64 * x + 8 * y + face) << (8 * y + 7 - face);
        beside[x] = (side > 0 ? (inside[x] >> 1) & ~kHighZ : (inside[x] << 1) & ~kLowZ) | outer;
      }
    }
    return beside;
  }

  bool crosses(const openvdb::Coord& at, int axis, int side) const {
    openvdb::Coord next = at;
    next[axis] += side;
    return field_.getValue(next) < value_;
  }

  openvdb::tree::ValueAccessor<const openvdb::FloatTree> field_;
  float value_;
};

/// Calls action(box, value) for each tile of a tree, active or not.
template <class Action>
void eachTileOf(const openvdb::FloatTree& tree, const Action& action) {
  auto tile = tree.cbeginValueAll();
  tile.setMaxDepth(openvdb::FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) action(tile.getBoundingBox(), *tile);
}

}  // namespace umbrick
