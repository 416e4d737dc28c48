// How a volume is cut into bricks for techniques on the CPU.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "umbrick/brick/bricks.h"
#include "umbrick/draw/value_picture.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// Returns how to cut a volume for a scene: with an apron of one voxel, since rays are sampled between the voxels of
/// their brick, and with gradients where the transfer function asks for them.
inline BrickOptions sweptBricks(const ResolvedScene& scene) {
  BrickOptions options;
  if (scene.bricks.interior > 0) options.interior = scene.bricks.interior;
  options.gradients = scene.transfer.is2d();
  options.gradientFilter = scene.gradients;
  // Central differences of a cell's corners look one voxel beyond them.
  if (isShaded(scene)) options.apron = kGradientApron;
  if (traitsOf(scene.mode).surfaces) options.apron = surfaceApron(scene);
  return options;
}

}  // namespace umbrick
