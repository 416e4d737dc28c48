// The box around a box that is turned, sheared or moved.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat4x4.hpp>

#include "umbrick/core/box.h"

namespace umbrick {

/// Returns the bounds of the eight corners of a box that is not empty. @param matrix  affine
inline Box transformed(const Box& box, const glm::dmat4& matrix) {
  Box bounds;
  for (int corner = 0; corner < 8; ++corner)
    bounds.include(
        glm::dvec3(matrix * glm::dvec4(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                       corner & 4 ? box.max.z : box.min.z, 1)));
  return bounds;
}

}  // namespace umbrick
