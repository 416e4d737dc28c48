// The loops of packets of rays, for each set of SIMD instructions that the machine may have.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "sweep/brick_voxels.h"
#include "sweep/row_kernels.h"

namespace umbrick {

/// Rays of a packet: a square of kPacketEdge pixels along each side. They are one group of the loops over rows.
inline constexpr int kPacketEdge = 4;
static_assert(kPacketEdge * kPacketEdge == kRayGroup);

/// A brick that rays of a packet meet on a slice, along the axes u and v of the slice. Places count from a voxel of the
/// packet.
struct PacketBrick {
  const void* voxels = nullptr;          // codes; none where all have one value
  const float* gradients = nullptr;      // of 2D functions
  const std::uint16_t* light = nullptr;  // by channel, see lightStride
  const float* media = nullptr;          // of classified voxels, by number, at the same stride; none: empty
  float value = 0;                       // in steps of the table, where there are no voxels
  const float* emission = nullptr;       // values of the second grid; none where all have one value,
  float emissionValue = 0;               // in steps of its table
  std::int32_t firstU = 0, firstV = 0;   // cells begin at these voxels,
  std::int32_t endU = 0, endV = 0;       // and end before these
  std::ptrdiff_t first = 0;              // where the voxel at (firstU, firstV) is, on the slice
};

/// A slice of voxels as a packet meets it.
struct PacketSlice {
  VoxelCode code = VoxelCode::f32;
  std::ptrdiff_t strideU = 1, strideV = 0, strideN = 0;  // between voxels
  float u = 0, v = 0;                                    // of the packet's middle ray, from the packet's voxel on
  float spread = 1;                                      // distance of rays from it: spread times those of the packet
  float n = 0;                                           // share of the next slice of voxels; 0: that is not read
  float bias = 0, factor = 1, first = 0;                 // steps = (code - bias) factor + first
  float gradientFactor = 1, gradientFirst = 0;
  float lightUnit = 1;
  std::ptrdiff_t lightStride = 0;  // between channels of light, and numbers of media
  int lights = 0;
  bool gradients = false, classified = false;
  bool emits = false;
  float emissionBias = 0, emissionFactor = 1, emissionFirst = 0;  // as those of values
};

/// Interpolates the fields of a packet's rays: those of the first brick that have their place in it, then those of the
/// next, and so on. Fields of other rays stay as they are.
/// @param across  distances of rays from the middle one along u, then along v
void samplePacket(const PacketSlice& slice, std::span<const PacketBrick> bricks, const float* acrossU,
                  const float* acrossV, float* const* fields);

}  // namespace umbrick
