// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/usual_value.h"

#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <map>

namespace umbrick {
namespace {

using openvdb::FloatTree;
using Leaves = openvdb::tree::LeafManager<const FloatTree>;

// The state of the vote: a candidate, and by how many voxels it leads. A value that more than half of all voxels have
// is the candidate at the end, in whatever order votes are added.
struct Vote {
  float value = 0;
  std::uint64_t lead = 0;

  void add(float other, std::uint64_t voxels) {
    if (other == value) {
      lead += voxels;
    } else if (voxels > lead) {
      value = other;
      lead = voxels - lead;
    } else {
      lead -= voxels;
    }
  }
};

// Whether a sixteenth of the leaves of a large tree leaves it open that one value has more than half of all voxels: a
// tenth less than half of the sample would be far off for tens of thousands of leaves.
bool mayHaveUsual(const Leaves& leaves) {
  constexpr std::size_t kLarge = 4096, kStep = 16;
  if (leaves.leafCount() < kLarge) return true;
  Vote vote;
  for (std::size_t i = 0; i < leaves.leafCount(); i += kStep)
    for (auto voxel = leaves.leaf(i).cbeginValueOn(); voxel; ++voxel) vote.add(*voxel, 1);
  std::uint64_t all = 0, same = 0;
  for (std::size_t i = 0; i < leaves.leafCount(); i += kStep)
    for (auto voxel = leaves.leaf(i).cbeginValueOn(); voxel; ++voxel) ++all, same += *voxel == vote.value;
  return 5 * same >= 2 * all;
}

Vote voteOf(const Leaves& leaves) {
  return tbb::parallel_deterministic_reduce(
      leaves.leafRange(64), Vote{},
      [](const auto& range, Vote vote) {
        for (auto leaf = range.begin(); leaf; ++leaf)
          for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) vote.add(*voxel, 1);
        return vote;
      },
      [](Vote a, const Vote& b) {
        a.add(b.value, b.lead);
        return a;
      });
}

std::uint64_t countOf(const Leaves& leaves, float value) {
  return tbb::parallel_reduce(
      leaves.leafRange(64), std::uint64_t(0),
      [value](const auto& range, std::uint64_t count) {
        for (auto leaf = range.begin(); leaf; ++leaf)
          for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) count += *voxel == value;
        return count;
      },
      std::plus<>());
}

// Calls action(value, voxels) for each active tile.
template <class Action>
void eachTile(const FloatTree& tree, const Action& action) {
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) action(*tile, static_cast<std::uint64_t>(tile.getVoxelCount()));
}

}  // namespace

std::optional<UsualValue> usualValue(const openvdb::FloatGrid& grid) {
  const FloatTree& tree = grid.tree();
  const Leaves leaves(tree);
  // Many tiles have few values, and are cheap to count.
  if (2 * leaves.leafCount() * FloatTree::LeafNodeType::SIZE > tree.activeVoxelCount() && !mayHaveUsual(leaves))
    return std::nullopt;
  Vote vote = voteOf(leaves);
  eachTile(tree, [&](float value, std::uint64_t voxels) { vote.add(value, voxels); });
  if (vote.lead == 0) return std::nullopt;
  UsualValue found{vote.value, countOf(leaves, vote.value)};
  eachTile(tree, [&](float value, std::uint64_t voxels) { found.voxels += value == found.value ? voxels : 0; });
  if (2 * found.voxels <= tree.activeVoxelCount()) return std::nullopt;
  return found;
}

std::optional<float> usualBorder(const openvdb::FloatGrid& grid) {
  constexpr int kAlongEdge = 24;  // 6 faces of 24 x 24 samples
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (box.empty()) return std::nullopt;
  const auto at = [&](int axis, int step) {
    return static_cast<int>(box.min()[axis] + std::int64_t(box.dim()[axis] - 1) * step / (kAlongEdge - 1));
  };
  const auto access = grid.getConstAccessor();
  std::map<float, int> counts;
  int all = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const int end : {0, kAlongEdge - 1})
      for (int u = 0; u < kAlongEdge; ++u)
        for (int v = 0; v < kAlongEdge; ++v) {
          openvdb::Coord place;
          place[axis] = at(axis, end);
          place[(axis + 1) % 3] = at((axis + 1) % 3, u);
          place[(axis + 2) % 3] = at((axis + 2) % 3, v);
          ++counts[access.getValue(place)];
          ++all;
        }
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& x, const auto& y) { return x.second < y.second; });
  return 10 * most->second >= all ? std::optional(most->first) : std::nullopt;
}

}  // namespace umbrick
