// SPDX-License-Identifier: Apache-2.0
#include "grid/surface_band.h"

#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_reduce.h>

#include <cmath>

#include "grid/crossing_edges.h"

namespace umbrick {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatTree;
using openvdb::MaskTree;
using Leaves = openvdb::tree::LeafManager<const FloatTree>;

// Marks voxels of the other lattice; parts of the volume may be marked apart and joined.
class Marks {
 public:
  Marks(const FloatTree& volume, float value, const glm::dmat4& toBand)
      : volume_(volume), value_(value), toBand_(toBand) {}
  Marks(Marks& other, tbb::split) : Marks(other.volume_, other.value_, other.toBand_) {}

  void operator()(const Leaves::LeafRange& range) {
    CrossingEdges edges(volume_, value_);
    for (auto leaf = range.begin(); leaf; ++leaf)
      edges.inLeaf(*leaf, [this](const Coord& at, int axis, int side) { mark(at, axis, side); });
  }
  void addTiles() {
    CrossingEdges edges(volume_, value_);
    eachTileOf(volume_, [&](const CoordBBox& box, float here) {
      edges.inTile(box, here, [this](const Coord& at, int axis, int side) { mark(at, axis, side); });
    });
  }
  void join(Marks& other) { tree_.topologyUnion(other.tree_); }
  MaskTree& tree() { return tree_; }

 private:
  void mark(const Coord& at, int axis, int side) {
    CoordBBox cells(at, at);
    for (int other = 0; other < 3; ++other) {
      if (other != axis || side < 0) --cells.min()[other];
      if (other != axis || side > 0) ++cells.max()[other];
    }
    glm::dvec3 first(HUGE_VAL), last(-HUGE_VAL);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 p(toBand_ * glm::dvec4(corner & 1 ? cells.max().x() : cells.min().x(),
                                              corner & 2 ? cells.max().y() : cells.min().y(),
                                              corner & 4 ? cells.max().z() : cells.min().z(), 1));
      first = glm::min(first, p);
      last = glm::max(last, p);
    }
    const auto whole = [](const glm::dvec3& v) { return Coord(int(v.x), int(v.y), int(v.z)); };
    tree_.fill(CoordBBox(whole(glm::floor(first)), whole(glm::ceil(last))), true, true);
  }

  const FloatTree& volume_;
  float value_;
  const glm::dmat4& toBand_;
  MaskTree tree_;
};

}  // namespace

std::array<std::uint64_t, 3> countCrossings(const FloatTree& volume, float value) {
  using Counts = std::array<std::uint64_t, 3>;
  const auto addTo = [](Counts& counts) {
    return [&counts](const Coord&, int axis, int) { ++counts[static_cast<std::size_t>(axis)]; };
  };
  const Leaves leaves(volume);
  Counts all = tbb::parallel_reduce(
      leaves.leafRange(16), Counts{},
      [&](const Leaves::LeafRange& range, Counts sum) {
        CrossingEdges edges(volume, value);
        for (auto leaf = range.begin(); leaf; ++leaf) edges.inLeaf(*leaf, addTo(sum));
        return sum;
      },
      [](const Counts& a, const Counts& b) {
        return Counts{a[0] + b[0], a[1] + b[1], a[2] + b[2]};
      });
  CrossingEdges edges(volume, value);
  eachTileOf(volume, [&](const CoordBBox& box, float here) { edges.inTile(box, here, addTo(all)); });
  return all;
}

MaskTree surfaceVoxels(const FloatTree& volume, float value, const glm::dmat4& toBand) {
  const Leaves leaves(volume);
  Marks marks(volume, value, toBand);
  tbb::parallel_reduce(leaves.leafRange(16), marks);
  marks.addTiles();
  marks.tree().voxelizeActiveTiles();
  return std::move(marks.tree());
}

}  // namespace umbrick
