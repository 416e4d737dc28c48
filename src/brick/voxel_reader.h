// Boxes of a grid's voxels, as arrays or as ranges of values.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "brick/leaf_range.h"
#include "brick/tree_walk.h"
#include "umbrick/core/range.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {

/// Reads boxes of a grid's voxels. Voxels that are not finite are read as background.
class VoxelReader {
 public:
  VoxelReader(const FloatTree& tree, float background) : tree_(tree), background_(background) {}

  // Says that all voxels of the grid are finite, which saves a test per voxel.
  void setAllFinite() { allFinite_ = true; }

  Range range(const openvdb::CoordBBox& box) const {
    Range range;
    walkTree(
        tree_, box, [&](const FloatLeaf& leaf, const openvdb::CoordBBox& part) { range.include(rangeOf(leaf, part)); },
        [&](float value, const openvdb::CoordBBox&) { range.include(finite(value)); });
    return range;
  }

  // Copies the voxels of a box, x fastest.
  void copy(const openvdb::CoordBBox& box, float* voxels) const {
    const openvdb::Coord size = box.dim();
    const std::size_t strideY = size.x(), strideZ = strideY * size.y();
    // Calls write(row, x, y, z, count) for each row of a part.
    const auto forEachRow = [&](const openvdb::CoordBBox& part, const auto& write) {
      const int count = part.max().x() - part.min().x() + 1;
      const openvdb::Coord local = part.min() - box.min();
      for (int k = 0; k <= part.max().z() - part.min().z(); ++k)
        for (int j = 0; j <= part.max().y() - part.min().y(); ++j)
          write(voxels + (local.z() + k) * strideZ + (local.y() + j) * strideY + local.x(), j, k, count);
    };
    walkTree(
        tree_, box,
        [&](const FloatLeaf& leaf, const openvdb::CoordBBox& part) {
          const float* first = leaf.buffer().data() + FloatLeaf::coordToOffset(part.min());
          forEachRow(part, [&](float* row, int j, int k, int count) {
            const float* source = first + j * FloatLeaf::DIM + k;
            for (int i = 0; i < count; ++i) row[i] = source[i * FloatLeaf::DIM * FloatLeaf::DIM];
          });
        },
        [&](float value, const openvdb::CoordBBox& part) {
          forEachRow(part, [&](float* row, int, int, int count) { std::fill_n(row, count, value); });
        });
    if (!allFinite_) std::transform(voxels, voxels + strideZ * size.z(), voxels, [&](float v) { return finite(v); });
  }

 private:
  float finite(float value) const { return std::isfinite(value) ? value : background_; }

  Range rangeOf(const FloatLeaf& leaf, const openvdb::CoordBBox& part) const {
    constexpr int edge = FloatLeaf::DIM;
    const float* values = leaf.buffer().data();
    if (allFinite_ && part.volume() == FloatLeaf::SIZE) return rangeOfLeaf(values);
    Range range;
    const openvdb::Coord a = part.min() - leaf.origin(), b = part.max() - leaf.origin();
    for (int x = a.x(); x <= b.x(); ++x)
      for (int y = a.y(); y <= b.y(); ++y)
        for (int z = a.z(); z <= b.z(); ++z) {
          const float value = values[(x * edge + y) * edge + z];
          range.include(allFinite_ ? value : finite(value));
        }
    return range;
  }

  const FloatTree& tree_;
  float background_;
  bool allFinite_ = false;
};

}  // namespace umbrick
