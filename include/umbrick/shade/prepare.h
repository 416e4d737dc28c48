// This file tells what the bricks of a volume must have so that a scene can be rendered.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/mat4x4.hpp>

#include "umbrick/atlas/brick_atlas.h"
#include "umbrick/brick/bricks.h"
#include "umbrick/core/box.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// Bounds of a volume's textures, which tests and checks set.
struct AtlasLimits {
  std::uint64_t maxTextureBytes = std::uint64_t{512} << 20;  // see AtlasOptions
  int maxTextureEdge = 0;
  std::uint64_t budgetBytes = 0;  // bytes of the textures that hold bricks; 0: the scene's budget
};

/// Returns how a volume is made resident for a scene: in the scene's texel format, within its memory budget.
/// @throw InvalidArgument  as parseVoxelFormat
AtlasOptions atlasOptions(const ResolvedScene& scene, const Bricks& volume, const AtlasLimits& limits = {});

/// Returns how a volume is cut for a scene: with gradients where its transfer function asks for them, in bricks of
/// brickInterior() voxels, with the apron that slabs need from wherever the volume is looked at, so that no change of
/// the camera's place cuts it anew. Where slabs are so thick that such an apron is wider than a brick, the apron is
/// that of the scene's own view.
/// @param worldBounds  box around the active voxels
/// @throw InvalidArgument  as requiredApron
BrickOptions requiredBricks(const ResolvedScene& scene, const glm::dmat4& indexToWorld, const Box& worldBounds);

/// Returns how many apron voxels the slabs of a resolved scene read beyond a brick: half a slab along the view rays.
/// @throw InvalidArgument  the spacing is so many voxels that the apron would be wider than a brick
int requiredApron(const ResolvedScene& resolved, const glm::dmat4& indexToWorld);

/// Returns the number of owned voxels along the edge of a brick. It is what the scene says, or for 0 the largest of
///   24                  small enough to skip most of what is empty
///   7 pixels            at the middle of the bounds, 48 at most: a rasteriser works in blocks of 4 x 4 pixels
///   3 aprons            so that a brick takes at most five times the memory of what it owns
/// rounded up to a multiple of 8, 256 at most.
/// @param worldBounds  box around the active voxels
/// @throw InvalidArgument  as requiredApron
int brickInterior(const ResolvedScene& resolved, const glm::dmat4& indexToWorld, const Box& worldBounds);

}  // namespace umbrick
