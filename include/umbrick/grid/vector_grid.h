// Dense volumes of three numbers a voxel, vectors or colours, to sparse grids of vec3.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openvdb/openvdb.h>

#include "umbrick/grid/build_grid.h"
#include "umbrick/grid/verify.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

struct BuiltVectors {
  openvdb::Vec3SGrid::Ptr grid;
  BuildReport report;  // an error is that of one number of a voxel, and all numbers are counted in means
};

/// Returns what the stored numbers of a colour are divided by, so that it lies from 0 to 1: the largest number of an
/// integer type, and 1 for floats. Vectors are not divided.
double colourScale(const VolumeInfo& info);

/// Reads a source of three numbers a voxel to its end. Of the options only name, background (of each number), tolerance
/// and progress are looked at: a voxel is left out where all of its numbers lie that close to the background.
/// Integer colours become 0 to 1. Vectors are turned by VolumeInfo::vectorToWorld, and else stay as they are stored.
/// A voxel with a number that is not finite becomes background and is counted.
/// @throw IoError          the source fails
/// @throw InvalidArgument  tolerance is negative, or as buildGrid
/// @pre source.info().valuesPerVoxel == 3
BuiltVectors buildVectorGrid(VoxelSource& source, const BuildOptions& options = {});

/// Reads the source to its end and compares, as verifyGrid does.
/// @param options  that the grid was built with
VerifyReport verifyVectorGrid(VoxelSource& source, const openvdb::Vec3SGrid& grid, const BuildOptions& options);

}  // namespace umbrick
