// SPDX-License-Identifier: Apache-2.0
#include "check/kit_voxels.h"

#include <openvdb/tools/Prune.h>

#include <memory>

#include "umbrick/grid/affine_matrix.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {
namespace {

// Calls visit(coordinates, value) for the voxels of a brick, `margin` of them beyond those that it owns.
template <class Visit>
void visitBrick(const Bricks& bricks, std::size_t brick, int margin, std::vector<float>& values, const Visit& visit) {
  const BrickLayout& layout = bricks.layout;
  const glm::ivec3 edge = layout.edge(), origin = bricks.bricks[brick].origin;
  values.resize(layout.voxels());
  bricks.read(origin, values);
  const int outside = layout.apron - margin;  // layers that are left out on each side
  for (int z = outside; z < edge.z - outside; ++z)
    for (int y = outside; y < edge.y - outside; ++y)
      for (int x = outside; x < edge.x - outside; ++x) {
        const glm::ivec3 at = origin - layout.apron + glm::ivec3(x, y, z);
        visit(openvdb::Coord(at.x, at.y, at.z), values[static_cast<std::size_t>((z * edge.y + y) * edge.x + x)]);
      }
}

ScalarGrid namedGrid(openvdb::FloatGrid::Ptr grid, const glm::dmat4& indexToWorld, const std::string& name) {
  grid->setTransform(openvdb::math::Transform::createLinearTransform(rowMatrix(indexToWorld)));
  grid->setName(name);
  ScalarGrid result;
  result.grid = std::move(grid);
  result.name = name;
  return result;
}

}  // namespace

ScalarGrid cleanGrid(const Bricks& bricks) {
  const auto grid = openvdb::FloatGrid::create(bricks.background);
  auto voxels = grid->getAccessor();
  std::vector<float> values;
  for (std::size_t i = 0; i < bricks.bricks.size(); ++i)
    visitBrick(bricks, i, 0, values, [&](const openvdb::Coord& at, float value) {
      if (value != bricks.background) voxels.setValue(at, value);
    });
  openvdb::tools::prune(grid->tree());
  return namedGrid(grid, bricks.indexToWorld, "density");
}

ScalarGrid brickAsGrid(const Bricks& bricks, std::size_t brick) {
  const auto grid = openvdb::FloatGrid::create(bricks.background);
  auto voxels = grid->getAccessor();
  std::vector<float> values;
  visitBrick(bricks, brick, bricks.layout.apron, values,
             [&](const openvdb::Coord& at, float value) { voxels.setValue(at, value); });
  return namedGrid(grid, bricks.indexToWorld, "brick_" + std::to_string(brick));
}

VoxelAt voxelsOf(const ScalarGrid& grid) {
  const auto accessor = std::make_shared<openvdb::FloatGrid::ConstAccessor>(grid.grid->getConstAccessor());
  return [accessor, keep = grid.grid](const glm::i64vec3& at) {
    return static_cast<double>(
        accessor->getValue(openvdb::Coord(static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z))));
  };
}

std::vector<float> denseVoxels(const ScalarGrid& grid, const IndexBox& box) {
  const glm::i64vec3 extent = box.extent();
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(extent.x * extent.y * extent.z));
  const auto voxels = grid.grid->getConstAccessor();
  for (int z = box.min.z; z <= box.max.z; ++z)
    for (int y = box.min.y; y <= box.max.y; ++y)
      for (int x = box.min.x; x <= box.max.x; ++x) values.push_back(voxels.getValue(openvdb::Coord(x, y, z)));
  return values;
}

}  // namespace umbrick
