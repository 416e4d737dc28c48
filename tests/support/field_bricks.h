// Bricks of a field that is given as a formula: a volume for tests that needs no grid.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <utility>
#include <vector>

#include "umbrick/brick/bricks.h"

namespace umbrick {

struct FieldOptions {
  int interior = 8;
  int apron = 1;
  float background = 0;
  bool gradients = false;
  glm::dmat4 indexToWorld{1};
};

/// Voxel i of a FieldBricks is field(i), everywhere: also beyond the box that its bricks cover.
class FieldBricks : public Bricks {
 public:
  using Field = std::function<double(const glm::ivec3&)>;

  /// @param box  the domain; cells of the lattice that meet it are bricks, but for those of nothing but background
  FieldBricks(Field field, const IndexBox& box, const FieldOptions& options = {}) : field_(std::move(field)) {
    layout.interior = glm::ivec3(options.interior);
    layout.apron = options.apron;
    indexToWorld = options.indexToWorld;
    toGradient_ = glm::transpose(glm::inverse(glm::dmat3(indexToWorld)));
    domain = box;
    background = options.background;
    hasGradients = options.gradients;
    value = {background, background};
    gradient = {0, 0};
    const auto cell = [&](int index) {
      return static_cast<int>(std::floor(static_cast<double>(index) / options.interior)) * options.interior;
    };
    std::vector<float> values(layout.voxels()), gradients(hasGradients ? layout.voxels() : 0);
    for (int z = cell(box.min.z); z <= box.max.z; z += options.interior)
      for (int y = cell(box.min.y); y <= box.max.y; y += options.interior)
        for (int x = cell(box.min.x); x <= box.max.x; x += options.interior) {
          Brick brick{{x, y, z}, {}, hasGradients ? Range{} : Range{0, 0}};
          read(brick.origin, values, gradients);
          for (const float v : values) brick.value.include(v);
          for (const float g : gradients) brick.gradient.include(g);
          value.include(brick.value);
          gradient.include(brick.gradient);
          if (brick.value != Range{background, background}) bricks.push_back(brick);
        }
  }

  void read(const glm::ivec3& origin, std::span<float> values, std::span<float> gradients = {}) const override {
    const glm::ivec3 edge = layout.edge();
    std::size_t i = 0;
    for (int z = 0; z < edge.z; ++z)
      for (int y = 0; y < edge.y; ++y)
        for (int x = 0; x < edge.x; ++x, ++i) {
          const glm::ivec3 index = origin - layout.apron + glm::ivec3(x, y, z);
          values[i] = static_cast<float>(field_(index));
          if (!gradients.empty()) gradients[i] = static_cast<float>(gradientAt(index));
        }
  }

  /// What trilinear interpolation gives at a point of index space.
  double trilinear(const glm::dvec3& index) const {
    const glm::dvec3 low = glm::floor(index), f = index - low;
    double sum = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
      const glm::ivec3 offset(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
      double weight = 1;
      for (int axis = 0; axis < 3; ++axis) weight *= offset[axis] ? f[axis] : 1 - f[axis];
      if (weight > 0) sum += weight * field_(glm::ivec3(low) + offset);
    }
    return sum;
  }
  double trilinearWorld(const glm::dvec3& point) const {
    return trilinear(glm::dvec3(glm::inverse(indexToWorld) * glm::dvec4(point, 1)));
  }

 private:
  double gradientAt(const glm::ivec3& index) const {
    glm::dvec3 difference;
    for (int axis = 0; axis < 3; ++axis) {
      glm::ivec3 step(0);
      step[axis] = 1;
      difference[axis] = 0.5 * (field_(index + step) - field_(index - step));
    }
    return glm::length(toGradient_ * difference);
  }

  Field field_;
  glm::dmat3 toGradient_;
};

}  // namespace umbrick
