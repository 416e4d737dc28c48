// Gradient magnitude of voxels in world units.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <limits>

namespace umbrick {

/// Takes central differences of neighbouring voxels and brings them to world space by the transpose of the inverse of
/// the linear part of the transform, since gradients are covectors. It computes in double precision, so that a result
/// depends on the voxels alone and not on where a brick begins.
class WorldGradient {
 public:
  explicit WorldGradient(const glm::dmat4& indexToWorld)
      : half_(0.5 * glm::transpose(glm::inverse(glm::dmat3(indexToWorld)))) {}

  /// Computes the magnitudes of `count` voxels along x, in grid units per world unit.
  /// @param row  the first of these voxels; its neighbours are at row +- 1, +- strideY and +- strideZ
  void magnitudes(const float* row, std::ptrdiff_t strideY, std::ptrdiff_t strideZ, int count, float* result) const {
    const glm::dmat3 m = half_;
    for (int i = 0; i < count; ++i) {
      const float* voxel = row + i;
      const double dx = static_cast<double>(voxel[1]) - voxel[-1];
      const double dy = static_cast<double>(voxel[strideY]) - voxel[-strideY];
      const double dz = static_cast<double>(voxel[strideZ]) - voxel[-strideZ];
      const double gx = m[0][0] * dx + m[1][0] * dy + m[2][0] * dz;
      const double gy = m[0][1] * dx + m[1][1] * dy + m[2][1] * dz;
      const double gz = m[0][2] * dx + m[1][2] * dy + m[2][2] * dz;
      const double size = std::sqrt(gx * gx + gy * gy + gz * gz);
      result[i] = static_cast<float>(std::min<double>(size, std::numeric_limits<float>::max()));
    }
  }

 private:
  glm::dmat3 half_;  // includes the 1/2 of the central difference
};

}  // namespace umbrick
