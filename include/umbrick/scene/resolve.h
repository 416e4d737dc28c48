// What follows from a scene once its volume is known.
#pragma once
#include <glm/mat4x4.hpp>

#include "umbrick/core/box.h"
#include "umbrick/scene/scene.h"

namespace umbrick {

/// The scene with everything that depends on the volume written out: an orbit becomes a camera, a spacing in voxels
/// (shortest edge) becomes world units. Resolving twice changes nothing.
/// @param worldBounds  of the volume, see orbitCamera
/// @throw InvalidArgument  no transfer function, an empty volume that an orbit should look at, or as validateScene
Scene resolveScene(const Scene& scene, const Box& worldBounds, const glm::dmat4& indexToWorld);

/// Length of a voxel's shortest edge, world units.
double shortestVoxelEdge(const glm::dmat4& indexToWorld);

/// The box, in index coordinates, that holds the medium: where the background is visible, the medium ends at its faces;
/// where it is not, nothing lies beyond it anyway. Renderers and reference use the same one.
/// @param domain  active voxels, and others that differ from the background, grown by one voxel: where interpolated
///                values may differ from the background. Gradient magnitudes may differ from 0 one voxel farther out,
///                so the box of a 2D function is larger by that.
IndexBox mediumBox(const TransferFunction& transfer, const IndexBox& domain);

}  // namespace umbrick
