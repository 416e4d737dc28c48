// What techniques on OpenGL share: which bricks a scene shows, and how a picture is read from its buffers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "shade/render_targets.h"
#include "shade/transfer_lookup.h"
#include "umbrick/atlas/resident_volume.h"
#include "umbrick/draw/renderer.h"

namespace umbrick {

/// Returns the bricks to draw, by their numbers in the atlas.
std::vector<std::int32_t> visibleBricks(ResidentVolume& resident, const TransferLookup& transfer, bool culling,
                                        bool backgroundVisible);

/// Tells whether the background of a volume is seen.
bool showsBackground(const TransferLookup& transfer, const Bricks& volume);

/// Light lies beside the slots of bricks, so that no two may share one.
SlotSharing sharingOf(const ResolvedScene& scene);

/// Checks what all techniques on OpenGL need. @throw InvalidArgument  the picture is larger than the driver's textures,
///   there are no gradients for a 2D transfer function, or the medium is to be classified before it is interpolated
void checkOnGl(const ResolvedScene& scene, const ResidentVolume& resident);

/// @throw InvalidArgument  the picture is larger than the driver's textures
void checkSize(const ResolvedScene& scene, const GlContext& context);

/// Fills in colour and, where the targets have layers, those.
/// @param brightest  the radiance that is 1 in the eye buffer
void readLayers(const GlFunctions& gl, const RenderTargets& targets, const ResolvedScene& scene, double brightest,
                Picture& picture);

/// Adds what is known of a volume's textures to the statistics.
void addTextures(const BrickAtlas& atlas, RenderStats& stats);

}  // namespace umbrick
