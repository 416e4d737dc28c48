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

#include "umbrick/optics/gradient_filter.h"

namespace umbrick {

/// Takes differences of neighbouring voxels and brings them to world space by the transpose of the inverse of the
/// linear part of the transform, since gradients are covectors. It computes in double precision, so that a result
/// depends on the voxels alone and not on where a brick begins.
class WorldGradient {
 public:
  WorldGradient(const glm::dmat4& indexToWorld, GradientFilter filter)
      : filter_(filter), half_(0.5 * glm::transpose(glm::inverse(glm::dmat3(indexToWorld)))) {}

  /// Computes the magnitudes of `count` voxels along x, in grid units per world unit.
  /// @param row  the first of these voxels; its neighbours are at row +- 1, +- strideY, +- strideZ and sums of these
  void magnitudes(const float* row, std::ptrdiff_t strideY, std::ptrdiff_t strideZ, int count, float* result) const {
    const glm::dmat3 m = half_;
    for (int i = 0; i < count; ++i) {
      const glm::dvec3 d = differencesAt(row + i, strideY, strideZ, filter_);
      const double gx = m[0][0] * d.x + m[1][0] * d.y + m[2][0] * d.z;
      const double gy = m[0][1] * d.x + m[1][1] * d.y + m[2][1] * d.z;
      const double gz = m[0][2] * d.x + m[1][2] * d.y + m[2][2] * d.z;
      const double size = std::sqrt(gx * gx + gy * gy + gz * gz);
      result[i] = static_cast<float>(std::min<double>(size, std::numeric_limits<float>::max()));
    }
  }

 private:
  GradientFilter filter_;
  glm::dmat3 half_;  // includes the 1/2 of the central difference
};

}  // namespace umbrick
