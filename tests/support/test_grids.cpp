// SPDX-License-Identifier: Apache-2.0
#include "support/test_grids.h"

#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <cmath>

#include "umbrick/grid/float_grid.h"

namespace umbrick {

ScalarGrid withTransform(ScalarGrid grid, const glm::dmat4& indexToWorld) {
  openvdb::Mat4d matrix;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) matrix[i][j] = indexToWorld[i][j];
  const openvdb::FloatGrid::Ptr copy = grid.grid->deepCopy();
  copy->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
  grid.grid = copy;
  return grid;
}

glm::dmat4 crookedTransform() {
  return glm::dmat4(0.8, 0.3, -0.1, 0, -0.25, 0.9, 0.2, 0, 0.4, 0.1, -1.7, 0, 12, -5, 3, 1);
}

ScalarGrid makeGrid(std::shared_ptr<openvdb::FloatGrid> grid) {
  grid->setName("density");
  ScalarGrid result;
  result.grid = grid;
  result.name = "density";
  return result;
}

ScalarGrid makeFilled(const glm::ivec3& dims, const glm::ivec3& origin,
                      const std::function<double(const glm::ivec3&)>& value, float background) {
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(background);
  openvdb::FloatGrid::Accessor accessor = grid->getAccessor();
  for (int x = 0; x < dims.x; ++x)
    for (int y = 0; y < dims.y; ++y)
      for (int z = 0; z < dims.z; ++z)
        accessor.setValue(openvdb::Coord(origin.x + x, origin.y + y, origin.z + z),
                          static_cast<float>(value(glm::ivec3(x, y, z))));
  return makeGrid(grid);
}

ScalarGrid makeDense(const glm::ivec3& dims, const glm::ivec3& origin, unsigned seed) {
  const SmoothField field(seed);
  return makeFilled(dims, origin, [&](const glm::ivec3& p) { return field(glm::dvec3(p)); });
}

ScalarGrid makeNoise(const glm::ivec3& dims, const glm::ivec3& origin, unsigned seed) {
  TestRandom random(seed);
  return makeFilled(dims, origin, [&](const glm::ivec3&) { return random.uniform(); });
}

ScalarGrid makeSparse(const glm::ivec3& origin, unsigned seed, int balls, int extent) {
  TestRandom random(seed);
  const SmoothField field(seed);
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0);
  openvdb::FloatGrid::Accessor accessor = grid->getAccessor();
  for (int ball = 0; ball < balls; ++ball) {
    const double radius = random.uniform(4, 12);
    const glm::dvec3 centre = random.point(glm::dvec3(12), glm::dvec3(extent - 12));
    const glm::ivec3 first(glm::ceil(centre - radius)), last(glm::floor(centre + radius));
    for (int x = first.x; x <= last.x; ++x)
      for (int y = first.y; y <= last.y; ++y)
        for (int z = first.z; z <= last.z; ++z) {
          const glm::dvec3 p(x, y, z);
          const double inside = 1 - glm::dot(p - centre, p - centre) / (radius * radius);
          if (inside <= 0) continue;
          const openvdb::Coord voxel(origin.x + x, origin.y + y, origin.z + z);
          const double value = inside * inside * (0.5 + field(p));
          accessor.setValue(voxel, std::max(accessor.getValue(voxel), static_cast<float>(value)));
        }
  }
  return makeGrid(grid);
}

ScalarGrid makeSphereLevelSet(double radius, double voxelSize, const glm::dvec3& centre) {
  return makeGrid(openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
      static_cast<float>(radius),
      openvdb::Vec3f(static_cast<float>(centre.x), static_cast<float>(centre.y), static_cast<float>(centre.z)),
      static_cast<float>(voxelSize)));
}

ScalarGrid makeTiles(float background) {
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(background);
  auto& tree = grid->tree();
  tree.addTile(1, openvdb::Coord(0, 0, 0), background + 1, true);
  tree.addTile(1, openvdb::Coord(8, 0, 0), background + 2, false);
  tree.addTile(1, openvdb::Coord(-48, 24, 16), background - 3, true);
  tree.addTile(1, openvdb::Coord(40, 40, 40), background, true);
  tree.addTile(2, openvdb::Coord(128, 0, 0), background + 0.5f, true);
  return makeGrid(grid);
}

ScalarGrid makeVoxels(const std::vector<std::pair<glm::ivec3, float>>& voxels, float background) {
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(background);
  for (const auto& [at, value] : voxels) grid->tree().setValue(openvdb::Coord(at.x, at.y, at.z), value);
  return makeGrid(grid);
}

}  // namespace umbrick
