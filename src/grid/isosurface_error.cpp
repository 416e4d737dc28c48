// SPDX-License-Identifier: Apache-2.0
#include "grid/isosurface_error.h"

#include <openvdb/tools/Interpolation.h>
#include <openvdb/tree/LeafManager.h>
#include <tbb/parallel_reduce.h>

#include <cmath>

#include "grid/crossing_edges.h"
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

  void add(const Coord& at, int axis, int side, Crossings& sum) const {
    Coord next = at;
    next[axis] += side;
    const float here = volume_.getValue(at), there = volume_.getValue(next);
    const double share = (double(value_) - double(here)) / (double(there) - double(here));
    const openvdb::Vec3d from = at.asVec3d(), point = from + (next.asVec3d() - from) * share;
    const glm::dvec4 p = toLevelSet_ * glm::dvec4(point[0], point[1], point[2], 1);
    const float distance = openvdb::tools::BoxSampler::sample(levelSet_, openvdb::Vec3d(p.x, p.y, p.z));
    sum.distance.add(std::abs(double(distance)));
    ++sum.count;
  }

 private:
  Access volume_, levelSet_;
  float value_;
  const glm::dmat4& toLevelSet_;
};

}  // namespace

void measureIsosurface(const openvdb::FloatTree& volume, float value, const openvdb::FloatGrid& levelSet,
                       const glm::dmat4& toLevelSet, IsosurfaceReport& report) {
  const openvdb::tree::LeafManager<const openvdb::FloatTree> leaves(volume);
  Crossings all = tbb::parallel_deterministic_reduce(
      leaves.leafRange(16), Crossings{},
      [&](const auto& range, Crossings sum) {
        const Measure measure(volume, value, levelSet.tree(), toLevelSet);
        CrossingEdges edges(volume, value);
        for (auto leaf = range.begin(); leaf; ++leaf)
          edges.inLeaf(*leaf, [&](const Coord& at, int axis, int side) { measure.add(at, axis, side, sum); });
        return sum;
      },
      [](Crossings a, const Crossings& b) {
        a.add(b);
        return a;
      });
  const Measure measure(volume, value, levelSet.tree(), toLevelSet);
  CrossingEdges edges(volume, value);
  eachTileOf(volume, [&](const openvdb::CoordBBox& box, float here) {
    edges.inTile(box, here, [&](const Coord& at, int axis, int side) { measure.add(at, axis, side, all); });
  });
  const double voxel = levelSet.voxelSize()[0];
  report.crossings = all.count;
  report.maxError = all.distance.max / voxel;
  report.rmsError = rootMean(all.distance.squares, all.count) / voxel;
}

}  // namespace umbrick
