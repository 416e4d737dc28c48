// Points at which a kit asks for values, chosen where interpolation in bricks goes wrong.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "check/kit_voxels.h"
#include "umbrick/core/box.h"

namespace umbrick {

/// What a sample needs: voxels that its brick owns, also some of the brick's apron, or nothing but background, outside
/// of all bricks.
enum class SamplePlace { inside, border, outside };

struct KitSample {
  glm::dvec3 index{0};  // index coordinates, voxel centres at integers
  int brick = -1;       // that owns the point; -1: none does
  SamplePlace place = SamplePlace::inside;
  double value = 0;  // interpolated in double precision
};

SamplePlace placeOf(const BrickFinder& bricks, const glm::dvec3& index);

/// Returns about `count` samples, from one brick after the other: at a voxel, somewhere, on a face, within the voxel on
/// either side of a face, of an edge and of a corner; and one in twelve around the volume.
/// @param origins  of the bricks, one or more   @param domain  of the volume, see Bricks
std::vector<KitSample> chooseSamples(const VoxelAt& voxel, const BrickFinder& bricks,
                                     const std::vector<glm::ivec3>& origins, const IndexBox& domain, std::size_t count,
                                     unsigned seed);

}  // namespace umbrick
