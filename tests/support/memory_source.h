// Voxels out of memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <vector>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

class MemorySource : public VoxelSource {
 public:
  MemorySource(const glm::i64vec3& dims, std::vector<float> voxels) : voxels_(std::move(voxels)) {
    info_.name = "memory";
    info_.dims = dims;
    info_.type = VoxelType::f32;
  }
  VolumeInfo& editInfo() { return info_; }
  double readSlab(std::int64_t count, std::span<float> out) override {
    std::copy_n(voxels_.begin() + at_, out.size(), out.begin());
    at_ += count * info_.dims.x * info_.dims.y * info_.valuesPerVoxel;
    return 0;
  }

 private:
  std::vector<float> voxels_;
  std::int64_t at_ = 0;
};

}  // namespace umbrick
