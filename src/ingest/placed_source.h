// A source that is put elsewhere in the world, or described otherwise; its voxels stay.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "umbrick/ingest/voxel_source.h"

namespace umbrick {

class PlacedSource : public VoxelSource {
 public:
  PlacedSource(std::unique_ptr<VoxelSource> source, VolumeInfo info) : source_(std::move(source)) {
    info_ = std::move(info);
  }
  double readSlab(std::int64_t count, std::span<float> out) override { return source_->readSlab(count, out); }
  void skipSlices(std::int64_t count) override { source_->skipSlices(count); }
  bool skipsFast() const override { return source_->skipsFast(); }
  std::optional<VoxelType> storedType() const override { return source_->storedType(); }
  void readStored(std::int64_t count, std::span<std::byte> out) override { source_->readStored(count, out); }

 private:
  std::unique_ptr<VoxelSource> source_;
};

}  // namespace umbrick
