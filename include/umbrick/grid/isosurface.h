// The surface where a volume has a value, as a level set.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "umbrick/grid/float_grid_fwd.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

struct IsosurfaceOptions {
  float value = 0;      // grid units; what has it or more is inside
  float halfWidth = 3;  // of the narrow band on each side of the surface, voxels, at least 1
};

/// How far the level set's zero crossing is from the surface, in voxels of the level set: |distance| at all points
/// where an edge between two voxels of the volume crosses the value, linearly from one to the other. They lie on the
/// trilinear surface exactly.
struct IsosurfaceReport {
  std::uint64_t crossings = 0;
  double maxError = 0, rmsError = 0;  // voxels
  double voxelSize = 0;               // world units
  std::uint64_t activeVoxels = 0, leaves = 0;
};

struct Isosurface {
  std::shared_ptr<openvdb::FloatGrid> grid;
  IsosurfaceReport report;
};

/// Signed distance in world units, negative inside, of OpenVDB's class "level set", with the metadata of the volume and
/// isosurface_value, isosurface_error_max and isosurface_error_rms (voxels). OpenVDB's tools mesh the surface and
/// measure distances to the mesh; which side a voxel is on is told by its value, so cavities are outside too.
///
/// Level sets have cubes for voxels. A grid that has such keeps its transform, rotation included; another becomes one
/// of its smallest spacing, along its own axes where these are at right angles, else along those of the world. Outside
/// of the grid there is its background, which closes surfaces that reach the faces of a volume.
/// @param volume  a fog volume
/// @throw InvalidArgument  value not finite or not above the background, no surface (tells the range of the values),
///                         halfWidth outside [1, 100], a level set, or a transform that is not affine
Isosurface makeIsosurface(const ScalarGrid& volume, const IsosurfaceOptions& options);

}  // namespace umbrick
