// SPDX-License-Identifier: Apache-2.0
#include "umbrick/atlas/resident_volume.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace umbrick {

ResidentVolume::ResidentVolume(const GlContext& context, const Bricks& volume, const AtlasOptions& options)
    : context_(context), volume_(volume), format_(options.format), atlas_(context, volume, options) {
  atlas_.append(volume.bricks);
}

std::span<const std::int32_t> ResidentVolume::background() {
  if (!hasBackground_) {
    const std::vector<Brick> cells = backgroundBricks(volume_);
    background_.resize(cells.size());
    std::iota(background_.begin(), background_.end(), static_cast<std::int32_t>(atlas_.bricks().size()));
    atlas_.append(cells);
    hasBackground_ = true;
  }
  return background_;
}

BrickSelection::BrickSelection(BrickAtlas& atlas, std::vector<std::int32_t> bricks, SlotSharing sharing)
    : atlas_(&atlas), bricks_(std::move(bricks)), sharing_(sharing), slots_(atlas.slotsFor(bricks_, sharing)) {
  origins_.reserve(bricks_.size());
  for (const std::int32_t brick : bricks_) origins_.push_back(atlas.bricks()[static_cast<std::size_t>(brick)].origin);
}

bool BrickSelection::reserve() {
  atlas_->reserve(slots_);
  return slots_ <= atlas_->slots();
}

void BrickSelection::require(std::span<const std::int32_t> positions) {
  std::vector<std::int32_t> wanted;
  wanted.reserve(positions.size());
  for (const std::int32_t position : positions) wanted.push_back(bricks_[static_cast<std::size_t>(position)]);
  atlas_->require(wanted, sharing_);
}

std::shared_ptr<ResidentVolume> ResidentVolumes::get(const Bricks& volume, const AtlasOptions& options) {
  const auto found = std::find_if(volumes_.begin(), volumes_.end(), [&](const auto& held) {
    return &held->volume() == &volume && held->format() == options.format;
  });
  if (found != volumes_.end()) {
    volumes_.splice(volumes_.begin(), volumes_, found);
    return volumes_.front();
  }
  std::uint64_t held = 0;
  for (const auto& one : volumes_) held += one->atlas().textureBytes();
  // What the new one will take is not known yet: half of the budget is left for it.
  for (auto one = volumes_.end(); one != volumes_.begin() && held > budgetBytes_ / 2;) {
    --one;
    if (one->use_count() > 1) continue;
    held -= (*one)->atlas().textureBytes();
    one = volumes_.erase(one);
  }
  return volumes_.emplace_front(std::make_shared<ResidentVolume>(context_, volume, options));
}

}  // namespace umbrick
