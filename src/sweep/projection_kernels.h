// The loops of projections, for each set of SIMD instructions that the machine may have.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "sweep/brick_voxels.h"
#include "sweep/row_kernels.h"

namespace umbrick {

/// What becomes of the samples of a ray.
enum class ProjectionKind { largest, smallest, sum };

/// The rays of a packet within a layer of bricks, along u, v and n, counted from a voxel that all bricks of the layer
/// share, so that each sample lies in the cells of exactly one of them.
struct ProjectionPath {
  using Lanes = std::array<float, kRayGroup>;
  Lanes u{}, v{};            // on the layer's first slice
  Lanes slopeU{}, slopeV{};  // from slice to slice
  Lanes low{}, high{};       // the part of each ray that counts, along n
  Lanes first{}, last{};     // the slices in it, as they are numbered below
};

/// A brick of the layer.
struct ProjectionBrick {
  const void* voxels = nullptr;  // codes; none where all have one value
  VoxelCode code = VoxelCode::f32;
  float offset = 0;                     // value = offset + code
  float value = 0;                      // where there are no voxels
  float background = 0;                 // sums are of what values are above it
  std::int32_t firstU = 0, firstV = 0;  // cells begin at these voxels
  std::int32_t endU = 0, endV = 0;      // and end before these
  std::ptrdiff_t first = 0;             // where the voxel at (firstU, firstV) of the layer's first slice is
  std::ptrdiff_t strideU = 1, strideV = 0, strideN = 0;
};

/// Takes the samples of a brick on some of the layer's slices. Slices are numbered from the layer's first one, `per` to
/// a voxel. @param begin,end  the first one and the one behind the last one
/// @param result  of each ray: the largest or the smallest sample so far; or the sum of samples, each times the length
///   along n that it stands for by the trapezoidal rule
void projectBrick(ProjectionKind kind, const ProjectionPath& path, const ProjectionBrick& brick, int per, int begin,
                  int end, float* result);

}  // namespace umbrick
