// What columns of voxels come to, and the box of voxels that a test accepts.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "grid/leaf_visits.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/grid/value_survey.h"

namespace umbrick {
namespace {

using Leaf = FloatLeaf;
using Leaves = FloatLeaves;

// A picture of columns, which several voxels share where the grid is large.
struct Columns {
  int across = 0, down = 0;  // the two axes of the picture
  IndexBox box;
  int perColumn = 1;  // voxels along each of the two
  int width = 0, height = 0;
  std::vector<double> sums = {};

  Columns(const IndexBox& active, int axis) : across((axis + 1) % 3), down((axis + 2) % 3), box(active) {
    constexpr std::int64_t kMost = 512;
    const glm::i64vec3 extent = box.extent();
    perColumn = static_cast<int>((std::max(extent[across], extent[down]) + kMost - 1) / kMost);
    width = static_cast<int>((extent[across] + perColumn - 1) / perColumn);
    height = static_cast<int>((extent[down] + perColumn - 1) / perColumn);
    sums.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  }
  int column(int index) const { return (index - box.min[across]) / perColumn; }
  int row(int index) const { return (index - box.min[down]) / perColumn; }
  double& at(int x, int y) { return sums[static_cast<std::size_t>(y) * std::size_t(width) + std::size_t(x)]; }
  void add(const Columns& other) {
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += other.sums[i];
  }
};

// Adds a tile: to each column as many voxels as they share.
void addTile(Columns& columns, int axis, double weight, const openvdb::CoordBBox& box) {
  const double depth = double(box.max()[axis]) - double(box.min()[axis]) + 1;
  const auto shared = [&](int least, int most, int first) {
    return double(std::min(most, first + columns.perColumn - 1) - std::max(least, first) + 1);
  };
  for (int y = columns.row(box.min()[columns.down]); y <= columns.row(box.max()[columns.down]); ++y)
    for (int x = columns.column(box.min()[columns.across]); x <= columns.column(box.max()[columns.across]); ++x) {
      const double wide = shared(box.min()[columns.across], box.max()[columns.across],
                                 columns.box.min[columns.across] + x * columns.perColumn);
      const double high = shared(box.min()[columns.down], box.max()[columns.down],
                                 columns.box.min[columns.down] + y * columns.perColumn);
      columns.at(x, y) += weight * depth * wide * high;
    }
}

struct Bounds {
  openvdb::CoordBBox box;
  void add(const Bounds& other) {
    if (!other.box.empty()) box.expand(other.box);
  }
};

}  // namespace

std::vector<double> columnIntegrals(const ScalarGrid& grid, int axis, const std::function<double(double)>& weight) {
  const IndexBox box = grid.activeBox();
  if (box.empty()) return {};
  const openvdb::FloatTree& tree = grid.grid->tree();
  const Leaves leaves(tree);
  Columns columns = overLeaves(leaves, Columns(box, axis), [&](const Leaf& leaf, Columns& state) {
    for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) {
      const float value = *voxel;
      if (!std::isfinite(value)) continue;
      const openvdb::Coord at = voxel.getCoord();
      state.at(state.column(at[state.across]), state.row(at[state.down])) += weight(value);
    }
  });
  visitTiles(tree, [&](float value, const openvdb::CoordBBox& tile) {
    if (std::isfinite(value)) addTile(columns, axis, weight(value), tile);
  });
  const double length = glm::length(glm::dvec3(grid.indexToWorld()[axis]));
  const double shared = double(columns.perColumn) * columns.perColumn;
  std::vector<double> integrals;
  for (const double sum : columns.sums)
    if (sum > 0) integrals.push_back(sum * length / shared);
  return integrals;
}

IndexBox acceptedBox(const ScalarGrid& grid, const std::function<bool(double)>& accepts) {
  const openvdb::FloatTree& tree = grid.grid->tree();
  const Leaves leaves(tree);
  Bounds bounds = overLeaves(leaves, Bounds{}, [&](const Leaf& leaf, Bounds& state) {
    // A leaf whose voxels lie inside already changes nothing.
    if (!state.box.empty() && state.box.isInside(leaf.getNodeBoundingBox())) return;
    for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel)
      if (accepts(*voxel)) state.box.expand(voxel.getCoord());
  });
  visitTiles(tree, [&](float value, const openvdb::CoordBBox& tile) {
    if (accepts(value)) bounds.box.expand(tile);
  });
  if (bounds.box.empty()) return {};
  const auto &low = bounds.box.min(), &high = bounds.box.max();
  return {{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}};
}

}  // namespace umbrick
