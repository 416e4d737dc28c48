// SPDX-License-Identifier: Apache-2.0
#include "reference/shaded_voxels.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "reference/voxel_gradient.h"

namespace umbrick {

ShadedVoxels::ShadedVoxels(const ScalarGrid& grid, const ResolvedScene& scene)
    : accessor_(grid.grid->getConstAccessor()),
      background_(std::isfinite(grid.grid->background()) ? static_cast<double>(grid.grid->background()) : 0),
      indexToWorld_(grid.indexToWorld()),
      gradientToWorld_(glm::transpose(glm::inverse(glm::dmat3(indexToWorld_)))),
      phong_(scene),
      camera_(scene.camera),
      gradients_(scene.gradients) {}

double ShadedVoxels::valueAt(openvdb::Coord at) const {
  const float value = accessor_.getValue(at);
  return std::isfinite(value) ? static_cast<double>(value) : background_;
}

glm::dvec3 ShadedVoxels::atVoxel(const openvdb::Coord& at) const {
  const glm::dvec3 world(indexToWorld_ * glm::dvec4(at.x(), at.y(), at.z(), 1));
  const glm::dvec3 viewer = camera_.projection == Projection::perspective ? glm::normalize(camera_.eye - world)
                                                                          : -cameraFrame(camera_).forward;
  const glm::dvec3 rise = gradientToWorld_ * voxelGradient(glm::dvec3(0), gradients_, [&](int i, int j, int k) {
                            return valueAt(at.offsetBy(i, j, k));
                          });
  const double length = glm::length(rise);
  glm::dvec3 normal = length > 0 ? rise / length : viewer;
  if (glm::dot(normal, viewer) < 0) normal = -normal;
  return phong_.direct(glm::dvec3(1), normal, viewer);
}

glm::dvec3 ShadedVoxels::direct(const glm::dvec3& point) const {
  const glm::dvec3 below = glm::floor(point), share = point - below;
  glm::dvec3 sum(0);
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    openvdb::Coord at;
    for (int axis = 0; axis < 3; ++axis) {
      const int upper = corner >> axis & 1;
      at[axis] = static_cast<int>(below[axis]) + upper;
      weight *= upper ? share[axis] : 1 - share[axis];
    }
    if (weight > 0) sum += weight * atVoxel(at);
  }
  return sum;
}

}  // namespace umbrick
