// The matrix of a linear OpenVDB transform.
#pragma once
#include <openvdb/math/Transform.h>

#include <glm/mat4x4.hpp>

namespace umbrick {

/// Index to world, for column vectors: the images of the axes and of the origin.
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

}  // namespace umbrick
