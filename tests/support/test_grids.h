// Small grids for tests. What looks random has a seed, so that a failure repeats.
#pragma once
#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <random>
#include <utility>
#include <vector>

#include "umbrick/grid/float_grid.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

/// Uniform numbers that are the same on every platform, unlike those of <random>'s distributions.
class TestRandom {
 public:
  explicit TestRandom(unsigned seed) : engine_(seed) {}
  double uniform() { return engine_() / 4294967296.0; }  // in [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  int below(int count) { return static_cast<int>(uniform() * count); }
  glm::dvec3 point(const glm::dvec3& low, const glm::dvec3& high) {
    const double x = uniform(), y = uniform(), z = uniform();  // in this order
    return low + (high - low) * glm::dvec3(x, y, z);
  }

 private:
  std::mt19937 engine_;
};

/// A sum of cosines of wavelengths from 10 to 40 voxels, in (0, 1): smooth at the scale of a voxel.
class SmoothField {
 public:
  explicit SmoothField(unsigned seed) {
    TestRandom random(seed);
    for (int i = 0; i < 8; ++i) {
      const glm::dvec3 direction = glm::normalize(random.point(glm::dvec3(-1), glm::dvec3(1)) + glm::dvec3(0, 0, 1e-3));
      waves_.push_back(
          {direction * (6.283185307179586 / random.uniform(10, 40)), random.uniform(0, 6.283185307179586)});
    }
  }
  double operator()(const glm::dvec3& point) const {
    double sum = 0;
    for (const auto& [wave, phase] : waves_) sum += std::cos(glm::dot(wave, point) + phase);
    return 0.5 + 0.49 * sum / static_cast<double>(waves_.size());
  }

 private:
  std::vector<std::pair<glm::dvec3, double>> waves_;
};

/// The same voxels in another place. @param indexToWorld  affine
inline ScalarGrid withTransform(ScalarGrid grid, const glm::dmat4& indexToWorld) {
  openvdb::Mat4d matrix;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) matrix[i][j] = indexToWorld[i][j];
  const openvdb::FloatGrid::Ptr copy = grid.grid->deepCopy();
  copy->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
  grid.grid = copy;
  return grid;
}

/// Rotated, anisotropic, sheared, mirrored and moved.
inline glm::dmat4 crookedTransform() {
  return glm::dmat4(0.8, 0.3, -0.1, 0, -0.25, 0.9, 0.2, 0, 0.4, 0.1, -1.7, 0, 12, -5, 3, 1);
}

inline ScalarGrid makeGrid(openvdb::FloatGrid::Ptr grid) {
  grid->setName("density");
  ScalarGrid result;
  result.grid = grid;
  result.name = "density";
  return result;
}

/// Active voxels origin to origin + dims - 1 with value(glm::ivec3 offset from the origin).
template <class Value>
ScalarGrid makeFilled(const glm::ivec3& dims, const glm::ivec3& origin, const Value& value, float background = 0) {
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(background);
  openvdb::FloatGrid::Accessor accessor = grid->getAccessor();
  for (int x = 0; x < dims.x; ++x)
    for (int y = 0; y < dims.y; ++y)
      for (int z = 0; z < dims.z; ++z)
        accessor.setValue(openvdb::Coord(origin.x + x, origin.y + y, origin.z + z),
                          static_cast<float>(value(glm::ivec3(x, y, z))));
  return makeGrid(grid);
}

/// A smooth field, cut off at the faces of its box.
inline ScalarGrid makeDense(const glm::ivec3& dims, const glm::ivec3& origin = glm::ivec3(0), unsigned seed = 1) {
  const SmoothField field(seed);
  return makeFilled(dims, origin, [&](const glm::ivec3& p) { return field(glm::dvec3(p)); });
}

/// Each voxel on its own, uniform in [0, 1).
inline ScalarGrid makeNoise(const glm::ivec3& dims, const glm::ivec3& origin = glm::ivec3(0), unsigned seed = 1) {
  TestRandom random(seed);
  return makeFilled(dims, origin, [&](const glm::ivec3&) { return random.uniform(); });
}

/// Soft balls, apart from each other, in a box of `extent` voxels from `origin`; background 0.
inline ScalarGrid makeSparse(const glm::ivec3& origin = glm::ivec3(0), unsigned seed = 1, int balls = 12,
                             int extent = 200) {
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

/// A narrow-band signed distance, negative and inactive inside.
inline ScalarGrid makeSphereLevelSet(double radius = 20, double voxelSize = 1,
                                     const glm::dvec3& centre = glm::dvec3(0)) {
  return makeGrid(openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
      static_cast<float>(radius),
      openvdb::Vec3f(static_cast<float>(centre.x), static_cast<float>(centre.y), static_cast<float>(centre.z)),
      static_cast<float>(voxelSize)));
}

/// No leaves: active and inactive tiles of 8^3 and 128^3 voxels, some beside each other.
inline ScalarGrid makeTiles(float background = 0) {
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(background);
  auto& tree = grid->tree();
  tree.addTile(1, openvdb::Coord(0, 0, 0), background + 1, true);
  tree.addTile(1, openvdb::Coord(8, 0, 0), background + 2, false);
  tree.addTile(1, openvdb::Coord(-48, 24, 16), background - 3, true);
  tree.addTile(1, openvdb::Coord(40, 40, 40), background, true);
  tree.addTile(2, openvdb::Coord(128, 0, 0), background + 0.5f, true);
  return makeGrid(grid);
}

/// Single active voxels.
inline ScalarGrid makeVoxels(const std::vector<std::pair<glm::ivec3, float>>& voxels, float background = 0) {
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(background);
  for (const auto& [at, value] : voxels) grid->tree().setValue(openvdb::Coord(at.x, at.y, at.z), value);
  return makeGrid(grid);
}

}  // namespace umbrick
