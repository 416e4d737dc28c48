// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "grid/label_names.h"
#include "umbrick/grid/label_grids.h"

namespace umbrick {
namespace {

LabelKey keyOf(const VolumeInfo& info, const SegmentFrame& frame) {
  const VolumeLabel& label = info.labels[frame.label];
  return {label.component, label.value};
}

// Calls for each pixel of the frame that the segment has a share of.
template <class Visit>
void eachShare(const VolumeInfo& info, const SegmentFrame& frame, const std::vector<float>& shares,
               const Visit& visit) {
  for (std::int64_t y = 0; y < info.dims.y; ++y)
    for (std::int64_t x = 0; x < info.dims.x; ++x)
      if (const float share = shares[static_cast<std::size_t>(y * info.dims.x + x)]; share > 0)
        visit(openvdb::Coord(int(x), int(y), int(frame.slice)), share);
}

// Reads the frames of the segments that are wanted, one after the other.
template <class Wants, class Take>
void eachFrame(SegmentSource& source, const std::function<void(double)>& progress, const Wants& wants,
               const Take& take) {
  const VolumeInfo& info = source.info();
  std::vector<float> shares(static_cast<std::size_t>(info.dims.x * info.dims.y));
  for (std::size_t i = 0; i < source.frames().size(); ++i) {
    const SegmentFrame& frame = source.frames()[i];
    if (!wants(keyOf(info, frame))) continue;
    source.read(i, shares);
    take(frame, shares);
    if (progress) progress(double(i + 1) / double(source.frames().size()));
  }
}

}  // namespace

LabelGrids buildSegmentGrids(SegmentSource& source, const LabelChoice& choice,
                             const std::function<void(double)>& progress) {
  openvdb::initialize();
  const VolumeInfo& info = source.info();
  const WantedLabels wanted(info, choice);
  std::map<LabelKey, LabelGrid> found;
  std::map<LabelKey, std::unique_ptr<openvdb::FloatGrid::Accessor>> accessors;
  eachFrame(
      source, progress, [&](const LabelKey& key) { return wanted.contains(key); },
      [&](const SegmentFrame& frame, const std::vector<float>& shares) {
        const LabelKey key = keyOf(info, frame);
        eachShare(info, frame, shares, [&](const openvdb::Coord& at, float share) {
          auto& access = accessors[key];
          if (!access)
            access = std::make_unique<openvdb::FloatGrid::Accessor>(labelGrid(info, key, found).grid->getAccessor());
          access->setValueOn(at, std::max(share, access->getValue(at)));
        });
      });
  accessors.clear();
  return wanted.collect(info, std::move(found));
}

std::vector<VerifyReport> verifySegmentGrids(SegmentSource& source, const std::vector<VolumeLabel>& labels,
                                             const std::vector<openvdb::FloatGrid::ConstPtr>& grids,
                                             const std::function<void(double)>& progress) {
  const VolumeInfo& info = source.info();
  const std::map<LabelKey, std::size_t> places = placesOf(labels);
  // The shares once more, since of frames in one place the largest counts.
  std::vector<openvdb::FloatGrid::Ptr> seen;
  for (std::size_t i = 0; i < grids.size(); ++i) seen.push_back(openvdb::FloatGrid::create(0.0f));
  eachFrame(
      source, progress, [&](const LabelKey& key) { return places.contains(key); },
      [&](const SegmentFrame& frame, const std::vector<float>& shares) {
        auto access = seen[places.at(keyOf(info, frame))]->getAccessor();
        eachShare(info, frame, shares, [&](const openvdb::Coord& at, float share) {
          access.setValueOn(at, std::max(share, access.getValue(at)));
        });
      });
  std::vector<VerifyReport> reports(grids.size());
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const auto access = grids[i]->getConstAccessor();
    std::uint64_t active = 0;
    for (auto voxel = seen[i]->cbeginValueOn(); voxel; ++voxel) {
      float value = 0;
      active += access.probeValue(voxel.getCoord(), value);
      reports[i].error.max = std::max(reports[i].error.max, std::abs(double(*voxel) - double(value)));
    }
    reports[i].voxels = voxelsIn(info);
    reports[i].beyond = grids[i]->activeVoxelCount() - active;
  }
  return reports;
}

}  // namespace umbrick
