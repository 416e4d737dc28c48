// The surface where a volume has a value, as a level set.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "umbrick/grid/float_grid_fwd.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

struct IsosurfaceOptions {
  float value = 0;      // grid units; where the volume has this value or more is inside
  float halfWidth = 3;  // half-width of the narrow band on each side of the surface, voxels, at least 1
};

/// How far the zero crossing of the level set is from the surface. It is measured as |distance| at all points where an
/// edge between two neighbouring voxels of the volume crosses the value, with values linear along the edge. These
/// points lie exactly on the trilinear surface. The unit of the errors is a voxel of the level set.
struct IsosurfaceReport {
  std::uint64_t crossings = 0;
  double maxError = 0, rmsError = 0;  // voxels of the level set
  double voxelSize = 0;               // edge of a voxel of the level set, world units
  std::uint64_t activeVoxels = 0, leaves = 0;
};

struct Isosurface {
  std::shared_ptr<openvdb::FloatGrid> grid;
  IsosurfaceReport report;
};

/// Makes a grid of signed distance in world units, negative inside, of OpenVDB's class "level set". It has the metadata
/// of the volume, and isosurface_value, isosurface_error_max and isosurface_error_rms (in voxels). Each edge between
/// two voxels that crosses the value gets a small disc of the surface, at right angles to the gradient, and a voxel the
/// distance to the nearest disc, up to five voxels from the surface; what is farther is swept from there by OpenVDB's
/// dilateSdf. The side of the surface on which a voxel lies is told by its value, so cavities are outside too.
///
/// The voxels of a level set are cubes. A grid whose voxels are cubes keeps its transform, rotation included. For
/// another grid the cubes have its smallest spacing and lie along its own axes where these are at right angles,
/// else along those of the world. Outside of the grid there is its background, which closes surfaces that reach the
/// faces of a volume.
/// @param volume  a fog volume
/// @throw InvalidArgument  value not finite or not above the background, no surface (the message tells the range of the
///                         values), halfWidth outside [1, 100], a level set, or a transform that is not affine
/// @throw MemoryError      the level set would not fit: the cubes of a volume whose spacings differ are many more than
///                         its voxels
Isosurface makeIsosurface(const ScalarGrid& volume, const IsosurfaceOptions& options);

}  // namespace umbrick
