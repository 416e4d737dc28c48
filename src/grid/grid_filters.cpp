// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/grid_filters.h"

#include <openvdb/tools/Dense.h>
#include <openvdb/tree/LeafManager.h>

#include <sstream>
#include <utility>

#include "umbrick/core/error.h"
#include "umbrick/grid/affine_matrix.h"
#include "umbrick/grid/grid_world.h"
#include "umbrick/grid/misplaced.h"

namespace umbrick {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using openvdb::FloatTree;

std::string quoted(const FloatGrid& grid) { return "grid \"" + grid.getName() + '"'; }

void refuseLevelSet(const FloatGrid& grid, const char* field) {
  if (grid.getGridClass() == openvdb::GRID_LEVEL_SET)
    throw InvalidArgument(quoted(grid) + ": " + field +
                          ": expected a fog volume, found a level set, whose surface would be cut open");
}

// Returns where the mask is active and not 0.
openvdb::MaskTree keptBy(const FloatGrid& mask) {
  openvdb::MaskTree kept(mask.tree(), false, true, openvdb::TopologyCopy());
  for (auto value = mask.cbeginValueOn(); value; ++value) {
    if (*value != 0) continue;
    if (value.isVoxelValue())
      kept.setValueOff(value.getCoord());
    else
      kept.fill(value.getBoundingBox(), false, false);
  }
  return kept;
}

class GridSource : public VoxelSource {
 public:
  GridSource(std::string name, FloatGrid::ConstPtr grid, const glm::i64vec3& dims) : grid_(std::move(grid)) {
    info_.name = std::move(name);
    info_.dims = dims;
    info_.type = VoxelType::f32;
    if (!grid_->transform().isLinear())
      throw InvalidArgument(info_.name + ": expected an affine transform, found " + grid_->transform().mapType());
    info_.indexToWorld = affineMatrix(grid_->transform());
    const World world = worldOf(*grid_);
    if (!world.space.empty()) info_.metadata["space"] = world.space;
    if (!world.lengthUnit.empty()) info_.metadata["length_unit"] = world.lengthUnit;
  }
  double readSlab(std::int64_t count, std::span<float> out) override {
    const int first = static_cast<int>(next_);
    const CoordBBox part(Coord(0, 0, first),
                         Coord(static_cast<int>(info_.dims.x - 1), static_cast<int>(info_.dims.y - 1),
                               static_cast<int>(next_ + count - 1)));
    openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(part, out.data());
    openvdb::tools::copyToDense(*grid_, dense);
    next_ += count;
    return 0;
  }
  void skipSlices(std::int64_t count) override { next_ += count; }
  bool skipsFast() const override { return true; }

 private:
  FloatGrid::ConstPtr grid_;
  std::int64_t next_ = 0;
};

}  // namespace

void cropGrid(FloatGrid& grid, const IndexBox& box) {
  refuseLevelSet(grid, "crop");
  const CoordBBox active = grid.evalActiveVoxelBoundingBox();
  const CoordBBox part(Coord(box.min.x, box.min.y, box.min.z), Coord(box.max.x, box.max.y, box.max.z));
  if (!part.empty()) grid.clip(part);
  if (part.empty() || grid.tree().empty() || grid.activeVoxelCount() == 0)
    throw InvalidArgument(quoted(grid) +
                          ": crop: expected a box that holds some of its active voxels, which lie from " +
                          vectorText(active.min()) + " to " + vectorText(active.max()) + ", found " +
                          vectorText(part.min()) + " to " + vectorText(part.max()));
}

std::uint64_t maskGrid(FloatGrid& grid, const FloatGrid& mask) {
  refuseLevelSet(grid, "mask");
  if (mask.background() != 0) {
    std::ostringstream message;
    message << "mask: background: expected 0, found " << mask.background();
    throw InvalidArgument(message.str());
  }
  if (const auto other = misplacedCorner(grid, mask, 1e-3))
    throw InvalidArgument("mask: position of voxel " + vectorText(other->voxel) + ": expected " +
                          vectorText(other->expected) + " as in " + quoted(grid) + ", found " +
                          vectorText(other->found));
  openvdb::MaskTree kept = keptBy(mask);
  kept.topologyIntersection(grid.tree());
  // The tree is made anew, since a voxel that is only switched off would keep its value.
  const auto tree = std::make_shared<FloatTree>(kept, grid.background(), grid.background(), openvdb::TopologyCopy());
  const auto access = grid.getConstAccessor();
  openvdb::tree::LeafManager<FloatTree> leaves(*tree);
  for (std::size_t i = 0; i < leaves.leafCount(); ++i)
    for (auto voxel = leaves.leaf(i).beginValueOn(); voxel; ++voxel) voxel.setValue(access.getValue(voxel.getCoord()));
  auto tile = tree->beginValueOn();
  tile.setMaxDepth(FloatTree::ValueOnIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) tile.setValue(access.getValue(tile.getCoord()));
  const std::uint64_t before = grid.activeVoxelCount();
  grid.setTree(tree);
  return before - grid.activeVoxelCount();
}

std::unique_ptr<VoxelSource> gridSource(std::string name, FloatGrid::ConstPtr grid, const glm::i64vec3& dims) {
  return std::make_unique<GridSource>(std::move(name), std::move(grid), dims);
}

}  // namespace umbrick
