// What the bricks of a volume must have for a scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/mat4x4.hpp>

#include "umbrick/atlas/brick_atlas.h"
#include "umbrick/brick/bricks.h"
#include "umbrick/core/box.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// Bounds of a volume's textures that tests and checks set.
struct AtlasLimits {
  std::uint64_t maxTextureBytes = std::uint64_t{512} << 20;  // see AtlasOptions
  int maxTextureEdge = 0;
  std::uint64_t budgetBytes = 0;  // of bricks' textures; 0: the scene's budget
};

/// How a volume is made resident for a scene: in its texel format, within its memory budget.
/// @throw InvalidArgument  as parseVoxelFormat
AtlasOptions atlasOptions(const ResolvedScene& scene, const Bricks& volume, const AtlasLimits& limits = {});

/// How a volume is cut for a scene: with gradients where its transfer function asks for them, in bricks of
/// brickInterior() voxels, with the apron that slabs need from wherever the volume is looked at, so that no change of
/// the camera's place cuts it anew. Where slabs are so thick that such an apron is wider than a brick, the apron is
/// that of the scene's own view.
/// @param worldBounds  of the active voxels
/// @throw InvalidArgument  as requiredApron
BrickOptions requiredBricks(const ResolvedScene& scene, const glm::dmat4& indexToWorld, const Box& worldBounds);

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
