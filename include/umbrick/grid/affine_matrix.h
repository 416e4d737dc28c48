// Matrices as glm and as OpenVDB have them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openvdb/math/Transform.h>

#include <glm/mat4x4.hpp>

namespace umbrick {

/// Returns the matrix from index space to world space, for column vectors: its columns are the images of the axes and
/// of the origin.
inline glm::dmat4 affineMatrix(const openvdb::math::Transform& transform) {
  const openvdb::math::MapBase& map = *transform.baseMap();
  glm::dmat4 matrix(1);
  for (int axis = 0; axis < 4; ++axis) {
    openvdb::Vec3d unit(0);
    if (axis < 3) unit[axis] = 1;
    const openvdb::Vec3d image = axis < 3 ? map.applyJacobian(unit) : map.applyMap(unit);
    for (int i = 0; i < 3; ++i) matrix[axis][i] = image[i];
  }
  return matrix;
}

/// Returns the same matrix for OpenVDB, which multiplies row vectors from the left.
inline openvdb::Mat4d rowMatrix(const glm::dmat4& matrix) {
  openvdb::Mat4d out;
  for (int axis = 0; axis < 4; ++axis)
    for (int i = 0; i < 4; ++i) out(axis, i) = matrix[axis][i];
  return out;
}

}  // namespace umbrick
