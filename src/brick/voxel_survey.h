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
  IndexBox extent;   // active voxels and all others that differ from the background
  Range value;       // the background included
  float anchor = 0;  // see Bricks
  VoxelFormat exactFormat = VoxelFormat::float32;
  std::uint64_t nonFiniteVoxels = 0;  // active
  bool hasNonFinite = false;          // active or inactive
  // Cells with a voxel near enough that it may differ from the background, ascending in z, then y, then x. Never fewer
  // than needed; a few more where a leaf is neither full nor empty.
  std::vector<glm::ivec3> cells;
};

/// More cells than this are refused: a lattice of them would not fit into memory anyway.
constexpr std::size_t kMaxCells = std::size_t(1) << 23;

/// @param background  stands for voxels that are not finite
/// @param interior    edge of a lattice cell, voxels, a multiple of 8
/// @param reach       cells see this many voxels beyond their faces
/// @throw InvalidArgument  more than kMaxCells cells
VoxelSurvey surveyVoxels(const openvdb::FloatTree& tree, float background, int interior, int reach);

/// Order of bricks: ascending in z, then y, then x.
inline bool comesBefore(const glm::ivec3& a, const glm::ivec3& b) {
  return a.z != b.z ? a.z < b.z : a.y != b.y ? a.y < b.y : a.x < b.x;
}

/// The lattice cell of a voxel, along one axis.
inline std::int64_t cellOf(std::int64_t voxel, std::int64_t interior) {
  return (voxel >= 0 ? voxel : voxel - interior + 1) / interior;
}

}  // namespace umbrick
