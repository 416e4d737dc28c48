// The inner loop of distances to a surface: the voxels of a leaf and the discs around it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>

namespace umbrick {

/// A disc of the surface, of radius kDiscRadius. Places are relative to the first voxel of the leaf that it lies in.
struct Disc {
  std::array<float, 3> centre, normal;
};

/// Neighbouring discs are one voxel apart at most, so that these overlap.
inline constexpr float kDiscRadius = 0.6f;  // voxels

/// The squared distances of the 8 x 8 x 8 voxels of a leaf to the nearest disc, z fastest.
using NearestDiscs = std::array<float, 512>;

/// Takes discs of a leaf into account for the voxels of another one.
/// @param shift  from the leaf of the voxels to that of the discs, voxels
/// @param reach  only voxels that are so close to the centre of a disc along x and y, and their rows along z, are
/// looked
///               at
void addDiscs(std::span<const Disc> discs, const std::array<int, 3>& shift, float reach, NearestDiscs& nearest);

}  // namespace umbrick
