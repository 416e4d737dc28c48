// Small grids for tests. What looks random has a seed, so that a failure repeats.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "umbrick/grid/float_grid_fwd.h"
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
ScalarGrid withTransform(ScalarGrid grid, const glm::dmat4& indexToWorld);

/// Rotated, anisotropic, sheared, mirrored and moved.
glm::dmat4 crookedTransform();

ScalarGrid makeGrid(std::shared_ptr<openvdb::FloatGrid> grid);

/// Active voxels origin to origin + dims - 1 with value(glm::ivec3 offset from the origin).
ScalarGrid makeFilled(const glm::ivec3& dims, const glm::ivec3& origin,
                      const std::function<double(const glm::ivec3&)>& value, float background = 0);

/// A smooth field, cut off at the faces of its box.
ScalarGrid makeDense(const glm::ivec3& dims, const glm::ivec3& origin = glm::ivec3(0), unsigned seed = 1);

/// Each voxel on its own, uniform in [0, 1).
ScalarGrid makeNoise(const glm::ivec3& dims, const glm::ivec3& origin = glm::ivec3(0), unsigned seed = 1);

/// Soft balls, apart from each other, in a box of `extent` voxels from `origin`; background 0.
ScalarGrid makeSparse(const glm::ivec3& origin = glm::ivec3(0), unsigned seed = 1, int balls = 12, int extent = 200);

/// A narrow-band signed distance, negative and inactive inside.
ScalarGrid makeSphereLevelSet(double radius = 20, double voxelSize = 1, const glm::dvec3& centre = glm::dvec3(0));

/// No leaves: active and inactive tiles of 8^3 and 128^3 voxels, some beside each other.
ScalarGrid makeTiles(float background = 0);

/// Single active voxels.
ScalarGrid makeVoxels(const std::vector<std::pair<glm::ivec3, float>>& voxels, float background = 0);

}  // namespace umbrick
