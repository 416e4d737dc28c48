// Phong's model at voxels, interpolated as values are: how a shaded medium is lit.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat4x4.hpp>

#include "reference/phong_model.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

/// Finds normals in the grid, in double precision. Each thread has one.
class ShadedVoxels {
 public:
  /// @throw InvalidArgument  as shadingLights
  ShadedVoxels(const ScalarGrid& grid, const ResolvedScene& scene);

  /// Returns the light that the medium sends to the eye at a point in index coordinates, for albedo 1, besides
  /// ambient().
  glm::dvec3 direct(const glm::dvec3& point) const;
  /// Returns the share that it sends without a light.
  double ambient() const { return phong_.ambient(); }

 private:
  double valueAt(openvdb::Coord at) const;
  glm::dvec3 atVoxel(const openvdb::Coord& at) const;

  openvdb::FloatGrid::ConstAccessor accessor_;
  double background_;
  glm::dmat4 indexToWorld_;
  glm::dmat3 gradientToWorld_;
  PhongModel phong_;
  Camera camera_;
  GradientFilter gradients_;
};

}  // namespace umbrick
