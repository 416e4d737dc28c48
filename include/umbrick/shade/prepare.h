// What the bricks of a volume must have for a scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat4x4.hpp>

#include "umbrick/core/box.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// Apron voxels that slabs of a resolved scene read beyond a brick: half a slab along the view rays.
/// @throw InvalidArgument  a spacing of so many voxels that the apron would be wider than a brick
int requiredApron(const ResolvedScene& resolved, const glm::dmat4& indexToWorld);

/// Owned voxels along the edge of a brick: what the scene says, or for 0 the largest of
///   24                  small enough to skip most of what is empty
///   7 pixels            at the middle of the bounds, 48 at most: a rasteriser works in blocks of 4 x 4 pixels
///   3 aprons            so that a brick takes at most five times the memory of what it owns
/// rounded up to a multiple of 8, 256 at most.
/// @param worldBounds  of the active voxels
/// @throw InvalidArgument  as requiredApron
int brickInterior(const ResolvedScene& resolved, const glm::dmat4& indexToWorld, const Box& worldBounds);

}  // namespace umbrick
