// SPDX-License-Identifier: Apache-2.0
#include "umbrick/ingest/split_components.h"

#include <algorithm>
#include <deque>
#include <utility>

namespace umbrick {
namespace {

// The slices that some component has read and others have not.
class SharedSlices {
 public:
  explicit SharedSlices(std::unique_ptr<VoxelSource> source)
      : source_(std::move(source)), next_(static_cast<std::size_t>(info().valuesPerVoxel), 0) {}

  const VolumeInfo& info() const { return source_->info(); }

  double read(std::size_t component, std::int64_t count, std::span<float> out) {
    const std::int64_t begin = next_[component], end = begin + count, held = first_ + std::ssize(slices_);
    if (end > held) fetch(end - held);
    const auto voxels = static_cast<std::size_t>(info().dims.x * info().dims.y);
    double error = 0;
    for (std::int64_t z = begin; z < end; ++z) {
      const Slice& slice = slices_[static_cast<std::size_t>(z - first_)];
      std::copy_n(slice.values.begin() + static_cast<std::ptrdiff_t>(component * voxels), voxels,
                  out.begin() + (z - begin) * static_cast<std::ptrdiff_t>(voxels));
      error = std::max(error, slice.error);
    }
    next_[component] = end;
    dropRead();
    return error;
  }

  void skip(std::size_t component, std::int64_t count) {
    next_[component] += count;
    dropRead();
  }

 private:
  struct Slice {
    std::vector<float> values;  // all voxels of one component, then those of the next
    double error = 0;
  };

  void fetch(std::int64_t count) {
    // What no component wants any more is behind all of them.
    if (const std::int64_t unread = first_ - fetched_; slices_.empty() && unread > 0) {
      source_->skipSlices(unread);
      fetched_ += unread;
    }
    const auto voxels = static_cast<std::size_t>(info().dims.x * info().dims.y);
    const auto several = static_cast<std::size_t>(info().valuesPerVoxel);
    slab_.resize(voxels * several * static_cast<std::size_t>(count));
    const double error = source_->readSlab(count, slab_);
    for (std::int64_t z = 0; z < count; ++z) {
      Slice& slice = slices_.emplace_back(Slice{std::vector<float>(voxels * several), error});
      const float* from = slab_.data() + static_cast<std::size_t>(z) * voxels * several;
      // Some voxels at a time, whose numbers stay in the cache from one component to the next.
      constexpr std::size_t kAtOnce = 64;
      for (std::size_t begin = 0; begin < voxels; begin += kAtOnce)
        for (std::size_t k = 0; k < several; ++k)
          for (std::size_t i = begin; i < std::min(begin + kAtOnce, voxels); ++i)
            slice.values[k * voxels + i] = from[i * several + k];
    }
    fetched_ += count;
  }

  void dropRead() {
    const std::int64_t least = *std::min_element(next_.begin(), next_.end());
    for (; first_ < least && !slices_.empty(); ++first_) slices_.pop_front();
    if (slices_.empty()) first_ = std::max(first_, least);
  }

  std::unique_ptr<VoxelSource> source_;
  std::vector<std::int64_t> next_;        // slice of each component
  std::int64_t first_ = 0, fetched_ = 0;  // of the slices that are held; read or skipped of the source
  std::deque<Slice> slices_;
  std::vector<float> slab_;
};

class SplitSource : public VoxelSource {
 public:
  SplitSource(std::shared_ptr<SharedSlices> shared, std::size_t component)
      : shared_(std::move(shared)), component_(component) {
    info_ = shared_->info();
    info_.valuesPerVoxel = 1;
  }
  double readSlab(std::int64_t count, std::span<float> out) override { return shared_->read(component_, count, out); }
  void skipSlices(std::int64_t count) override { shared_->skip(component_, count); }

 private:
  std::shared_ptr<SharedSlices> shared_;
  std::size_t component_;
};

}  // namespace

std::vector<std::unique_ptr<VoxelSource>> splitComponents(std::unique_ptr<VoxelSource> source) {
  const auto several = static_cast<std::size_t>(source->info().valuesPerVoxel);
  const auto shared = std::make_shared<SharedSlices>(std::move(source));
  std::vector<std::unique_ptr<VoxelSource>> out;
  for (std::size_t i = 0; i < several; ++i) out.push_back(std::make_unique<SplitSource>(shared, i));
  return out;
}

}  // namespace umbrick
