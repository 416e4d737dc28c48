// The media of voxels, for pictures that interpolate these and not the values.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "sweep/brick_voxels.h"
#include "umbrick/optics/transfer_function.h"

namespace umbrick {

/// Stores the medium of each voxel with the bricks that are held.
/// @param most  largest sigma_t that makes a difference, 1/world unit
void classify(BrickVoxels& voxels, const TransferFunction& transfer, double most);
/// Lets them go.
void forgetMedia(BrickVoxels& voxels);

}  // namespace umbrick
