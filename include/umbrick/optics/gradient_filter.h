// How gradients are found between voxels.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <glm/vec3.hpp>

#include "umbrick/core/names.h"

namespace umbrick {

/// `central`: differences of the two voxels beside a voxel, and between voxels their trilinear interpolation; this has
/// kinks at the faces of cells. `bspline`: the gradient of the cubic B-spline in three dimensions that has the voxels
/// as its coefficients. It has continuous slopes and weighs 3 x 3 x 3 voxels around a voxel, or 4 x 4 x 4 around a
/// cell, so that noise of one voxel and the next is half as large and edges are softer by about a voxel. Both are exact
/// where the field is a polynomial of degree 2. Of x^3 both give 3 x^2 + 1 at voxels, which central differences exceed
/// between them by up to 3/4. Where magnitudes of gradients are looked up (2D transfer functions) or where a medium
/// reflects light, gradients are those at voxels, and magnitudes or reflected light are interpolated; at surfaces they
/// are those of the very point. Source: Sigg and Hadwiger 2005, "Fast Third-Order Texture Filtering", GPU Gems 2,
/// chapter 20
enum class GradientFilter { central, bspline };
inline constexpr Name<GradientFilter> kGradientFilters[]{{"central", GradientFilter::central},
                                                         {"bspline", GradientFilter::bspline}};

/// Returns twice the gradient at a voxel, along the volume's axes and per voxel, in double precision.
/// @param voxel  has neighbours at +- 1, +- strideY and +- strideZ; for `bspline` also at sums of these
inline glm::dvec3 differencesAt(const float* voxel, std::ptrdiff_t strideY, std::ptrdiff_t strideZ,
                                GradientFilter filter) {
  const std::ptrdiff_t strides[3]{1, strideY, strideZ};
  const auto difference = [&](const float* at, int axis) {
    return static_cast<double>(at[strides[axis]]) - static_cast<double>(at[-strides[axis]]);
  };
  if (filter == GradientFilter::central) return {difference(voxel, 0), difference(voxel, 1), difference(voxel, 2)};
  // The spline's weights at a voxel are 1/6, 4/6 and 1/6, its slope is a central difference.
  glm::dvec3 sum(0);
  for (int axis = 0; axis < 3; ++axis)
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i)
        sum[axis] += (i == 0 ? 4 : 1) * (j == 0 ? 4 : 1) *
                     difference(voxel + i * strides[(axis + 1) % 3] + j * strides[(axis + 2) % 3], axis);
  return sum / 36.0;
}

}  // namespace umbrick
