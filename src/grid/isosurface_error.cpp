// SPDX-License-Identifier: Apache-2.0
#include "grid/isosurface_error.h"

#include <openvdb/tools/Interpolation.h>
#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_reduce.h>

#include <cmath>

#include "grid/sparse_rule.h"

namespace umbrick {
namespace {

using openvdb::Coord;
using Access = openvdb::tree::ValueAccessor<const openvdb::FloatTree>;

struct Crossings {
  LossSum distance;  // world units
  std::uint64_t count = 0;
  void add(const Crossings& other) {
    distance.add(other.distance);
    count += other.count;
  }
};

class Measure {
 public:
  Measure(const openvdb::FloatTree& volume, float value, const openvdb::FloatTree& levelSet,
          const glm::dmat4& toLevelSet)
      : volume_(volume), levelSet_(levelSet), value_(value), toLevelSet_(toLevelSet) {}

  // Adds the edges from a voxel to those behind it along each axis. Edges to voxels before it are added too where no
  // leaf is that counts them as its own.
  void addEdges(const Coord& at, float here, Crossings& sum) {
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) {
        Coord next = at;
        next[axis] += side;
        if (side > 0 || !volume_.probeConstLeaf(next)) addEdge(at, here, next, sum);
      }
  }

  void addEdge(const Coord& at, float here, const Coord& next, Crossings& sum) {
    const float there = volume_.getValue(next);
    if ((here < value_) == (there < value_)) return;
    const double share = (double(value_) - double(here)) / (double(there) - double(here));
    const openvdb::Vec3d from = at.asVec3d(), point = from + (next.asVec3d() - from) * share;
    const glm::dvec4 p = toLevelSet_ * glm::dvec4(point[0], point[1], point[2], 1);
    const float distance = openvdb::tools::BoxSampler::sample(levelSet_, openvdb::Vec3d(p.x, p.y, p.z));
    sum.distance.add(std::abs(double(distance)));
    ++sum.count;
  }

  bool inLeaf(const Coord& at) { return volume_.probeConstLeaf(at) != nullptr; }

 private:
  Access volume_, levelSet_;
  float value_;
  const glm::dmat4& toLevelSet_;
};

// Adds the edges that cross a face of a tile with no leaf beyond it.
void addTile(Measure& measure, const openvdb::CoordBBox& box, float here, Crossings& sum) {
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      openvdb::CoordBBox face = box;
      (side > 0 ? face.min() : face.max())[axis] = side > 0 ? box.max()[axis] : box.min()[axis];
      for (const Coord& at : face) {
        Coord next = at;
        next[axis] += side;
        if (!measure.inLeaf(next)) measure.addEdge(at, here, next, sum);
      }
    }
}

}  // namespace

void measureIsosurface(const openvdb::FloatTree& volume, float value, const openvdb::FloatGrid& levelSet,
                       const glm::dmat4& toLevelSet, IsosurfaceReport& report) {
  const openvdb::tree::LeafManager<const openvdb::FloatTree> leaves(volume);
  Crossings all = tbb::parallel_deterministic_reduce(
      leaves.leafRange(16), Crossings{},
      [&](const auto& range, Crossings sum) {
        Measure measure(volume, value, levelSet.tree(), toLevelSet);
        for (auto leaf = range.begin(); leaf; ++leaf)
          for (openvdb::Index i = 0; i < Leaf::SIZE; ++i)
            measure.addEdges(leaf->offsetToGlobalCoord(i), leaf->getValue(i), sum);
        return sum;
      },
      [](Crossings a, const Crossings& b) {
        a.add(b);
        return a;
      });
  Measure measure(volume, value, levelSet.tree(), toLevelSet);
  auto tile = volume.cbeginValueOn();
  tile.setMaxDepth(openvdb::FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) addTile(measure, tile.getBoundingBox(), *tile, all);
  const double voxel = levelSet.voxelSize()[0];
  report.crossings = all.count;
  report.maxError = all.distance.max / voxel;
  report.rmsError = rootMean(all.distance.squares, all.count) / voxel;
}

}  // namespace umbrick
