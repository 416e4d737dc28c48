// A volume's bricks on the GPU, shared by all that draws them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <list>
#include <memory>
#include <span>
#include <vector>

#include "umbrick/atlas/brick_atlas.h"

namespace umbrick {

/// Holds the atlas of a volume as long as renderers need it, however often their scenes change. Which bricks are
/// visible is a renderer's business; a brick that is resident is not uploaded again.
class ResidentVolume {
 public:
  /// @param volume  outlives this, as does `context`, which is current
  /// @throw InvalidArgument  as BrickAtlas
  ResidentVolume(const GlContext& context, const Bricks& volume, const AtlasOptions& options);

  ResidentVolume(const ResidentVolume&) = delete;  // renderers point to it
  ResidentVolume& operator=(const ResidentVolume&) = delete;

  const GlContext& context() const { return context_; }
  const Bricks& volume() const { return volume_; }
  VoxelFormat format() const { return format_; }
  BrickAtlas& atlas() { return atlas_; }
  const BrickAtlas& atlas() const { return atlas_; }

  /// Returns the atlas's numbers of the cells that hold nothing but background, which must be drawn where that is
  /// visible. They are listed when they are asked for first. @throw InvalidArgument  as backgroundBricks
  std::span<const std::int32_t> background();

 private:
  const GlContext& context_;
  const Bricks& volume_;
  VoxelFormat format_;
  BrickAtlas atlas_;
  std::vector<std::int32_t> background_;
  bool hasBackground_ = false;
};

/// The bricks that a renderer draws, each by its position in the selection.
class BrickSelection {
 public:
  /// @param bricks  the atlas's numbers
  BrickSelection(BrickAtlas& atlas, std::vector<std::int32_t> bricks, SlotSharing sharing = SlotSharing::shared);

  std::size_t size() const { return bricks_.size(); }
  /// Slots that they take.
  std::size_t slots() const { return slots_; }
  /// First owned voxel of each.
  std::span<const glm::ivec3> origins() const { return origins_; }
  const Brick& brick(std::int32_t position) const {
    return atlas_->bricks()[static_cast<std::size_t>(bricks_[static_cast<std::size_t>(position)])];
  }
  BrickAtlas::Slot slot(std::int32_t position) const {
    return atlas_->slot(bricks_[static_cast<std::size_t>(position)]);
  }
  /// Number of a brick's slot; the brick must be resident.
  std::int32_t slotNumber(std::int32_t position) const {
    return atlas_->slotNumber(bricks_[static_cast<std::size_t>(position)]);
  }
  const BrickAtlas& atlas() const { return *atlas_; }

  /// Makes room for as many of them as the atlas's budget allows. @return whether all of them fit
  bool reserve();
  /// As BrickAtlas::require, by position.
  void require(std::span<const std::int32_t> positions);

 private:
  BrickAtlas* atlas_;
  std::vector<std::int32_t> bricks_;
  std::vector<glm::ivec3> origins_;
  SlotSharing sharing_;
  std::size_t slots_;
};

/// Several volumes, or one volume cut in several ways, each uploaded once as long as all of them fit a budget; those
/// that nobody holds and that were used longest ago leave.
class ResidentVolumes {
 public:
  ResidentVolumes(const GlContext& context, std::uint64_t budgetBytes) : context_(context), budgetBytes_(budgetBytes) {}
  /// Returns the volume as it is held, or makes it resident.
  /// @param volume   outlives this
  /// @param options  of one that is held already, only the format counts
  /// @throw InvalidArgument  as BrickAtlas
  std::shared_ptr<ResidentVolume> get(const Bricks& volume, const AtlasOptions& options);

 private:
  const GlContext& context_;
  std::uint64_t budgetBytes_;
  std::list<std::shared_ptr<ResidentVolume>> volumes_;  // used last first
};

}  // namespace umbrick
