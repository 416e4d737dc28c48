// SPDX-License-Identifier: Apache-2.0
#include "convert/segment_filters.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "umbrick/ingest/world.h"

namespace umbrick {
namespace {

// A dense volume of ones in the place of the segments. What the filters of volumes make of it says where the segments
// lie then, and which of their pixels stay.
class PlaceOfSegments : public VoxelSource {
 public:
  explicit PlaceOfSegments(const VolumeInfo& info) { info_ = info; }
  double readSlab(std::int64_t, std::span<float> out) override {
    std::fill(out.begin(), out.end(), 1.0f);
    return 0;
  }
  void skipSlices(std::int64_t) override {}
  bool skipsFast() const override { return true; }
};

class FilteredSegments : public SegmentSource {
 public:
  FilteredSegments(std::unique_ptr<SegmentSource> segments, VoxelSource& place, const SourceOptions& options,
                   ReadNotes& notes)
      : segments_(std::move(segments)), notes_(notes) {
    info_ = place.info();
    if (options.crop) first_ = glm::i64vec3(options.crop->min);
    for (std::size_t i = 0; i < segments_->frames().size(); ++i) {
      SegmentFrame frame = segments_->frames()[i];
      frame.slice -= first_.z;
      if (frame.slice < 0 || frame.slice >= info_.dims.z) continue;
      frames_.push_back(frame);
      from_.push_back(i);
    }
    if (!options.mask.empty()) readMask(place);
    notes_.leftOut = 0;
  }

  void read(std::size_t frame, std::span<float> out) override {
    const glm::i64vec3& whole = segments_->info().dims;
    picture_.resize(static_cast<std::size_t>(whole.x * whole.y));
    segments_->read(from_[frame], picture_);
    auto to = out.begin();
    for (std::int64_t y = 0; y < info_.dims.y; ++y)
      to = std::copy_n(picture_.begin() + (first_.y + y) * whole.x + first_.x, info_.dims.x, to);
    if (kept_.empty()) return;
    const std::size_t slice = out.size() * static_cast<std::size_t>(frames_[frame].slice);
    for (std::size_t i = 0; i < out.size(); ++i)
      if (!kept_[slice + i]) notes_.leftOut += std::exchange(out[i], 0.0f) != 0;
  }

 private:
  // Frames come in any order, so that the mask is held, a bit a voxel.
  void readMask(VoxelSource& place) {
    std::vector<float> slice(static_cast<std::size_t>(info_.dims.x * info_.dims.y));
    kept_.reserve(slice.size() * static_cast<std::size_t>(info_.dims.z));
    for (std::int64_t z = 0; z < info_.dims.z; ++z) {
      place.readSlab(1, slice);
      for (const float keep : slice) kept_.push_back(keep != 0);
    }
  }

  std::unique_ptr<SegmentSource> segments_;
  ReadNotes& notes_;
  glm::i64vec3 first_{0};          // voxel of the segmentation that becomes (0, 0, 0)
  std::vector<std::size_t> from_;  // of each frame: which one of the segmentation
  std::vector<bool> kept_;         // by the mask, x fastest; empty: all
  std::vector<float> picture_;
};

}  // namespace

std::unique_ptr<SegmentSource> filteredSegments(std::unique_ptr<SegmentSource> segments, const SourceOptions& options,
                                                ReadNotes& notes) {
  const bool turned = !options.open.space.empty() || options.world;
  if (!turned && options.mask.empty() && !options.crop) return segments;
  std::unique_ptr<VoxelSource> place = std::make_unique<PlaceOfSegments>(segments->info());
  if (!options.open.space.empty()) place = inSpace(std::move(place), options.open.space);
  SourceOptions filters = options;
  filters.resample.reset();
  place = openFiltered({}, filters, 0, notes, std::move(place));
  return std::make_unique<FilteredSegments>(std::move(segments), *place, options, notes);
}

}  // namespace umbrick
