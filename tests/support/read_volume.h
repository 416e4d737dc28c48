// All voxels of a source at once.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

/// In slabs of one slice and then of the rest, so that slabs are tried too.
inline std::vector<float> readVolume(VoxelSource& source) {
  const glm::i64vec3 dims = source.info().dims;
  const auto slice = static_cast<std::size_t>(dims.x * dims.y);
  std::vector<float> out(slice * static_cast<std::size_t>(dims.z));
  source.readSlab(1, std::span(out).first(slice));
  if (dims.z > 1) source.readSlab(dims.z - 1, std::span(out).subspan(slice));
  return out;
}

}  // namespace umbrick
