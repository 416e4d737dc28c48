// Voxels that lie in memory, such as those of a simulation or a NumPy array, as volumes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>

#include "umbrick/ingest/volume_parts.h"
#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// An array of the caller's, who keeps it alive and unchanged while it is read. It is read where it lies: no more than
/// a voxel slab of it is copied at a time, whatever its order.
struct ArrayVolume {
  const std::byte* data = nullptr;  // the first number of voxel (0, 0, 0)
  glm::i64vec3 dims{0};             // voxels along x, y, z
  glm::i64vec3 strides{0};          // bytes from a voxel to its neighbour along x, y, z, of any order and sign
  VoxelType type = VoxelType::f32;
  std::endian endian = std::endian::native;
  std::int64_t components = 1;       // numbers of a voxel
  std::int64_t componentStride = 0;  // bytes from one of them to the next
  /// Takes the index of a voxel, whose centre it is, to the world; affine. None: voxels are 1 apart and the first is at
  /// 0, or as OpenOptions::spacing and origin say.
  std::optional<glm::dmat4> indexToWorld = {};
};

/// Opens an array as a volume, whose metadata say source_format "array".
/// @param name  what messages call it
/// @throw InvalidArgument  dims outside [1, 2^31), components outside [1, 65536], a matrix that is not affine and
///                         invertible
/// @throw SeveralParts     several components, and `parts` chooses none
std::unique_ptr<VoxelSource> openArray(const ArrayVolume& array, const std::string& name, const PartChoice& parts = {});

}  // namespace umbrick
