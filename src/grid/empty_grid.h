// A grid that holds nothing yet, described and placed as a volume is.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openvdb/openvdb.h>

#include <string>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// Gives the grid the name, the volume's metadata and place, and the class of a fog volume.
/// @throw InvalidArgument  OpenVDB refuses the transform (voxels of less than 3e-15 cubed world units)
void placeVolumeGrid(const VolumeInfo& info, const std::string& name, openvdb::GridBase& grid);

}  // namespace umbrick
