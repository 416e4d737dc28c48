// Distances to the surface where a volume has a value, in a narrow band.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <glm/mat4x4.hpp>
#include <vector>

#include "grid/disc_kernel.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {

/// Discs of the surface that lie in one leaf.
struct LeafDiscs {
  openvdb::Coord origin;
  std::vector<Disc> discs;
};

/// Returns a disc for each edge between two voxels that crosses the value, with values linear along the edge: at the
/// crossing, at right angles to the gradient there. Along the edge that is the slope of the edge, else the mean of the
/// central differences at both ends.
/// @param activeOnly  only edges between two active voxels count
/// @param toBand      from indices of the field to those of the lattice on which distances are measured
std::vector<LeafDiscs> surfaceDiscs(const openvdb::FloatTree& field, float value, bool activeOnly,
                                    const glm::dmat4& toBand = glm::dmat4(1));

/// Half-widths up to which distances are found from the discs around each voxel.
inline constexpr float kMostDirect = 5;  // voxels

/// Makes a level set of distances to the nearest disc, in voxels. For a plane surface and values linear across it all
/// this is exact. Discs of a curved surface stick out: one of radius r gets thicker by 0.2 / r voxels at most.
/// @param halfWidth  voxels, from 1 to kMostDirect
/// @param isInside   returns a function that tells the side of a voxel of the lattice, for one thread
openvdb::FloatGrid::Ptr distanceBand(const std::vector<LeafDiscs>& discs, float halfWidth,
                                     const std::function<std::function<bool(const openvdb::Coord&)>()>& isInside);

}  // namespace umbrick
