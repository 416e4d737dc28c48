// What slabs must make of a scene, computed on the CPU in double precision from the voxels themselves: without bricks,
// textures, tables, polygons or culling.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/core/box.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/image/image.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// Emission and absorption by slabs: slab i lies at depths [i, i + 1] spacing, clip planes cut it along the ray, what
/// is left is cut into equal segments. Preintegrated, the value of a segment, and for a 2D function the gradient
/// magnitude, run linearly from its front to its back, and what such a ramp scatters and absorbs is integrated piece by
/// piece of the function; midpoint, the medium is that of the middle. The error of this picture is that of the slabs,
/// and of nothing else.
/// @param domain  active voxels, and others that differ from the background, grown by one. A visible background ends
///                there; for a 2D function one voxel farther out, where gradients do
/// @param scene   emission, whatever its model is
Image slabPicture(const ScalarGrid& grid, const ResolvedScene& scene, const IndexBox& domain);

/// The same with other slabs: each stretch of a ray between two faces of voxel cells in so many parts. The interpolated
/// value has its kinks at those faces, so that this converges with the square of the parts also where a narrow peak of
/// the function meets a kink, which slabs of any one thickness cut off.
Image cellPicture(const ScalarGrid& grid, const ResolvedScene& scene, const IndexBox& domain, int parts);

}  // namespace umbrick
