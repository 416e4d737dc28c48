// One pass over all voxels of a grid: what values there are, and which lattice cells they reach.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "umbrick/brick/bricks.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {

struct VoxelSurvey {
  IndexBox extent;   // box of active voxels and of all others that differ from the background
  Range value;       // over all voxels, the background included
  float anchor = 0;  // see Bricks
  VoxelFormat exactFormat = VoxelFormat::float32;
  std::uint64_t nonFiniteVoxels = 0;  // active voxels that are NaN or infinite
  bool hasNonFinite = false;          // true also when only inactive voxels are not finite
  // Cells with a voxel near enough that it may differ from the background, ascending in z, then y, then x. No cell is
  // missing, but there are a few too many where a leaf is neither full nor empty.
  std::vector<glm::ivec3> cells;
};

/// More cells than this are refused, since so large a lattice would not fit into memory anyway.
constexpr std::size_t kMaxCells = std::size_t(1) << 23;

/// @param background  value that stands for voxels that are not finite
/// @param interior    edge of a lattice cell, voxels, a multiple of 8
/// @param reach       how far beyond its faces a cell sees voxels, in voxels
/// @throw InvalidArgument  more than kMaxCells cells
VoxelSurvey surveyVoxels(const openvdb::FloatTree& tree, float background, int interior, int reach);

/// Returns whether brick a stands before brick b in their order: ascending in z, then y, then x.
inline bool comesBefore(const glm::ivec3& a, const glm::ivec3& b) {
  return a.z != b.z ? a.z < b.z : a.y != b.y ? a.y < b.y : a.x < b.x;
}

/// Returns the lattice cell of a voxel, along one axis.
inline std::int64_t cellOf(std::int64_t voxel, std::int64_t interior) {
  return (voxel >= 0 ? voxel : voxel - interior + 1) / interior;
}

}  // namespace umbrick
