// SPDX-License-Identifier: Apache-2.0
#include "umbrick/atlas/brick_atlas.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <set>
#include <utility>

#include "atlas/texel_format.h"
#include "atlas/texels.h"
#include "core/mebibytes.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

bool isUniform(const Brick& brick) {
  return brick.uniform() && brick.gradient.min == brick.gradient.max && brick.emission.min == brick.emission.max;
}

}  // namespace

BrickAtlas::BrickAtlas(const GlContext& context, const Bricks& volume, const AtlasOptions& options)
    : gl_(context.gl()), volume_(volume), format_(options.format), options_(options) {
  valueScale_ = texelScale(volume, format_);
  maxEdge_ = options.maxTextureEdge > 0 ? std::min(options.maxTextureEdge, context.maxTextureEdge3d())
                                        : context.maxTextureEdge3d();
  checkLimits(maxEdge_);
  affordable_ = static_cast<std::size_t>(options.budgetBytes / slotBytes());
}

BrickAtlas::BrickAtlas(const GlContext& context, const Bricks& volume, std::vector<Brick> bricks,
                       const AtlasOptions& options)
    : BrickAtlas(context, volume, options) {
  append(bricks);
  reserve(slotsForAll_);
}

std::uint64_t BrickAtlas::slotBytes() const { return volume_.layout.voxels() * texelFormat(format_, volume_).bytes; }

void BrickAtlas::checkLimits(int maxEdge) {
  const glm::ivec3 edge = volume_.layout.edge();
  if (std::max({edge.x, edge.y, edge.z}) > maxEdge)
    throw InvalidArgument("bricks: one of " + std::to_string(edge.x) + " x " + std::to_string(edge.y) + " x " +
                          std::to_string(edge.z) + " voxels does not fit a 3D texture, whose edge is at most " +
                          std::to_string(maxEdge) + " texels");
  if (options_.budgetBytes < slotBytes())
    throw InvalidArgument("bricks.budgetMiB: one brick takes " + mebibytes(slotBytes()) + ", the memory budget is " +
                          mebibytes(options_.budgetBytes));
}

std::size_t BrickAtlas::slotsFor(std::span<const std::int32_t> bricks, SlotSharing sharing) const {
  if (sharing == SlotSharing::apart) return bricks.size();
  std::set<UniformKey> values;
  std::size_t slots = 0;
  for (const std::int32_t index : bricks) {
    const Brick& brick = bricks_[static_cast<std::size_t>(index)];
    if (!isUniform(brick) || values.emplace(brick.value.min, brick.gradient.min, brick.emission.min).second) ++slots;
  }
  return slots;
}

void BrickAtlas::append(const std::vector<Brick>& bricks) {
  bricks_.insert(bricks_.end(), bricks.begin(), bricks.end());
  slotOf_.resize(bricks_.size(), -1);
  std::vector<std::int32_t> all(bricks_.size());
  std::iota(all.begin(), all.end(), 0);
  slotsForAll_ = std::max<std::size_t>(1, slotsFor(all));
}

// How slots are arranged in textures, which are of one size.
BrickAtlas::Plan BrickAtlas::planTextures(std::size_t slots) const {
  Plan plan;
  // Slots are stacked along z first, then y, then x: a driver that stores texels row by row (all software ones) then
  // keeps a brick in few pages of memory.
  const glm::ivec3 edge = volume_.layout.edge();
  const glm::ivec3 most = maxEdge_ / edge;
  std::uint64_t perTexture = std::uint64_t(most.x) * std::uint64_t(most.y) * std::uint64_t(most.z);
  perTexture = std::max<std::uint64_t>(1, std::min(perTexture, options_.maxTextureBytes / slotBytes()));
  // Textures of one size share all uniforms: the slots are spread evenly.
  const std::uint64_t textures = (slots + perTexture - 1) / perTexture;
  const auto rest = static_cast<int>((slots + textures - 1) / textures);
  const auto divideUp = [](int a, int b) { return (a + b - 1) / b; };
  // What is left is divided evenly over each axis, so that no axis is filled up by slots nobody needs.
  const int columns = divideUp(rest, most.z);
  plan.slotGrid.x = divideUp(columns, most.y);
  plan.slotGrid.y = divideUp(columns, plan.slotGrid.x);
  plan.slotGrid.z = divideUp(rest, plan.slotGrid.x * plan.slotGrid.y);
  plan.size = plan.slotGrid * edge;
  return plan;
}

void BrickAtlas::reserve(std::size_t wanted) {
  wanted = std::min(std::max<std::size_t>(1, wanted), affordable_);
  if (wanted <= slots_) return;
  const std::size_t before = slots_;
  const auto fitBoth = [&](std::size_t slots) {
    return static_cast<std::uint64_t>(before + slots) * slotBytes() <= options_.budgetBytes;
  };
  // A pool that has to grow may have to grow again: by half, so that this does not happen often, but not beyond what
  // all bricks take, nor so far that there is no room for a copy.
  std::size_t slots = wanted;
  const std::size_t larger =
      std::min({affordable_, std::max(wanted, slotsForAll_), std::max(wanted, before + before / 2)});
  if (before > 0 && (fitBoth(larger) || !fitBoth(wanted))) slots = larger;
  if (!fitBoth(slots)) clear();
  const std::size_t kept = slots_;
  const Plan plan = planTextures(slots);
  const TexelFormat texel = texelFormat(format_, volume_);
  std::vector<GlTexture> textures;
  const auto perTexture = static_cast<std::size_t>(plan.slotGrid.x * plan.slotGrid.y * plan.slotGrid.z);
  for (std::size_t held = 0; held < slots; held += perTexture)
    textures.push_back(makeTexture3d(gl_, texel.internal, plan.size.x, plan.size.y, plan.size.z));
  const glm::ivec3 edge = volume_.layout.edge();
  for (std::size_t slot = 0; slot < kept; ++slot) {
    if (users_[slot] == 0) continue;
    const Slot from = place(static_cast<std::int32_t>(slot), plan_.slotGrid);
    const Slot to = place(static_cast<std::int32_t>(slot), plan.slotGrid);
    gl_.CopyImageSubData(textures_[static_cast<std::size_t>(from.texture)].name(), GL_TEXTURE_3D, 0, from.origin.x,
                         from.origin.y, from.origin.z, textures[static_cast<std::size_t>(to.texture)].name(),
                         GL_TEXTURE_3D, 0, to.origin.x, to.origin.y, to.origin.z, edge.x, edge.y, edge.z);
  }
  checkGl(gl_, "growth of the pool of bricks");
  // The last one is taken first: slots are filled from 0 on.
  std::vector<std::int32_t> added(slots - kept);
  std::iota(added.rbegin(), added.rend(), static_cast<std::int32_t>(kept));
  users_.resize(slots, 0);
  requiredAt_.resize(slots, 0);
  free_.insert(free_.begin(), added.begin(), added.end());
  textures_ = std::move(textures);
  plan_ = plan;
  slots_ = slots;
  ++generation_;
}

// An atlas of no slot, so that whatever fails next finds it whole.
void BrickAtlas::clear() {
  textures_.clear();
  slotOf_.assign(bricks_.size(), -1);
  users_.clear();
  requiredAt_.clear();
  free_.clear();
  uniform_.clear();
  slots_ = 0;
  plan_ = {};
  ++generation_;
}

BrickAtlas::Slot BrickAtlas::place(std::int32_t slot, const glm::ivec3& slotGrid) const {
  const int perTexture = slotGrid.x * slotGrid.y * slotGrid.z;
  const int within = slot % perTexture;
  const glm::ivec3 cell(within / (slotGrid.z * slotGrid.y), within / slotGrid.z % slotGrid.y, within % slotGrid.z);
  return {slot / perTexture, cell * volume_.layout.edge()};
}

BrickAtlas::Slot BrickAtlas::slot(std::int32_t brick) const {
  return place(slotOf_[static_cast<std::size_t>(brick)], plan_.slotGrid);
}

std::uint64_t BrickAtlas::textureBytes() const {
  return textures_.size() * std::uint64_t(plan_.size.x) * std::uint64_t(plan_.size.y) * std::uint64_t(plan_.size.z) *
         texelFormat(format_, volume_).bytes;
}

bool BrickAtlas::mayShare(std::int32_t brick, SlotSharing sharing) const {
  return sharing == SlotSharing::shared && isUniform(bricks_[static_cast<std::size_t>(brick)]);
}

// Takes a brick out of a slot that it shares, and lets no other brick into one that it has for itself.
void BrickAtlas::setApart(std::int32_t brick) {
  const Brick& one = bricks_[static_cast<std::size_t>(brick)];
  if (!isUniform(one) || !isResident(brick)) return;
  if (users_[static_cast<std::size_t>(slotNumber(brick))] > 1) return release(brick);
  const auto shared = uniform_.find({one.value.min, one.gradient.min, one.emission.min});
  if (shared != uniform_.end() && shared->second == slotNumber(brick)) uniform_.erase(shared);
}

void BrickAtlas::require(std::span<const std::int32_t> bricks, SlotSharing sharing) {
  ++requests_;
  if (sharing == SlotSharing::apart)
    for (const std::int32_t brick : bricks) setApart(brick);
  std::vector<std::int32_t> missing;
  std::set<UniformKey> missingValues;
  std::size_t wanted = 0;
  for (const std::int32_t brick : bricks) {
    const Brick& one = bricks_[static_cast<std::size_t>(brick)];
    const UniformKey key{one.value.min, one.gradient.min, one.emission.min};
    const bool mayShareSlot = mayShare(brick, sharing);
    const auto shared = mayShareSlot ? uniform_.find(key) : uniform_.end();
    if (isResident(brick) || shared != uniform_.end()) {
      const std::int32_t slot = isResident(brick) ? slotOf_[static_cast<std::size_t>(brick)] : shared->second;
      requiredAt_[static_cast<std::size_t>(slot)] = requests_;
    } else if (!mayShareSlot || missingValues.insert(key).second) {
      ++wanted;
    }
    if (!isResident(brick)) missing.push_back(brick);
  }
  if (wanted > free_.size()) evict(wanted - free_.size());
  std::vector<std::pair<std::int32_t, std::int32_t>> uploads;
  for (const std::int32_t brick : missing) {
    if (isResident(brick)) continue;  // listed twice
    const Brick& one = bricks_[static_cast<std::size_t>(brick)];
    const UniformKey key{one.value.min, one.gradient.min, one.emission.min};
    const bool mayShareSlot = mayShare(brick, sharing);
    const auto shared = mayShareSlot ? uniform_.find(key) : uniform_.end();
    std::int32_t slot;
    if (shared != uniform_.end()) {
      slot = shared->second;
    } else {
      slot = free_.back();
      free_.pop_back();
      if (mayShareSlot) uniform_[key] = slot;
      uploads.emplace_back(brick, slot);
    }
    slotOf_[static_cast<std::size_t>(brick)] = slot;
    requiredAt_[static_cast<std::size_t>(slot)] = requests_;
    ++users_[static_cast<std::size_t>(slot)];
  }
  try {
    upload(uploads);
  } catch (...) {
    // What was not uploaded is not resident.
    for (const std::int32_t brick : missing) release(brick);
    throw;
  }
}

// Frees slots that the present call of require() does not ask for, those first that were asked for longest ago.
void BrickAtlas::evict(std::size_t slots) {
  std::vector<std::int32_t> idle;
  for (std::size_t slot = 0; slot < slots_; ++slot)
    if (users_[slot] > 0 && requiredAt_[slot] < requests_) idle.push_back(static_cast<std::int32_t>(slot));
  if (idle.size() < slots)
    throw InvalidArgument("bricks.budgetMiB: one slice needs more than the " + std::to_string(slots_) + " bricks (" +
                          mebibytes(slots_ * slotBytes()) + ") that the memory budget holds");
  std::stable_sort(idle.begin(), idle.end(), [&](std::int32_t a, std::int32_t b) {
    return requiredAt_[static_cast<std::size_t>(a)] < requiredAt_[static_cast<std::size_t>(b)];
  });
  std::vector<bool> leaves(slots_, false);
  for (std::size_t i = 0; i < slots; ++i) leaves[static_cast<std::size_t>(idle[i])] = true;
  for (std::size_t brick = 0; brick < bricks_.size(); ++brick)
    if (slotOf_[brick] >= 0 && leaves[static_cast<std::size_t>(slotOf_[brick])])
      release(static_cast<std::int32_t>(brick));
}

void BrickAtlas::release(std::int32_t brick) {
  std::int32_t& slot = slotOf_[static_cast<std::size_t>(brick)];
  if (slot < 0) return;
  if (--users_[static_cast<std::size_t>(slot)] == 0) {
    const Brick& held = bricks_[static_cast<std::size_t>(brick)];
    const auto shared = uniform_.find({held.value.min, held.gradient.min, held.emission.min});
    if (isUniform(held) && shared != uniform_.end() && shared->second == slot) uniform_.erase(shared);
    free_.push_back(slot);
  }
  slot = -1;
}

void BrickAtlas::upload(std::span<const std::pair<std::int32_t, std::int32_t>> brickAndSlot) {
  const TexelFormat texel = texelFormat(format_, volume_);
  const std::size_t voxels = volume_.layout.voxels();
  const glm::ivec3 edge = volume_.layout.edge();
  // Bricks are read and encoded by all cores, some at a time to bound the memory. This thread then hands them
  // to the driver.
  const std::size_t batch = std::clamp<std::size_t>((std::size_t{64} << 20) / (voxels * texel.bytes), 1, 256);
  std::vector<std::byte> staging(std::min(batch, brickAndSlot.size()) * voxels * texel.bytes);
  struct Scratch {
    std::vector<float> values, gradients, emission;
    double error = 0;
  };
  tbb::enumerable_thread_specific<Scratch> scratches;
  resetGlState(gl_);
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (std::size_t first = 0; first < brickAndSlot.size(); first += batch) {
    const std::size_t count = std::min(batch, brickAndSlot.size() - first);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1), [&](const auto& range) {
      Scratch& scratch = scratches.local();
      scratch.values.resize(voxels);
      if (volume_.hasGradients) scratch.gradients.resize(voxels);
      if (volume_.hasEmission) scratch.emission.resize(voxels);
      for (std::size_t i = range.begin(); i != range.end(); ++i) {
        const Brick& brick = bricks_[static_cast<std::size_t>(brickAndSlot[first + i].first)];
        volume_.read(brick.origin, scratch.values, scratch.gradients);
        if (volume_.hasEmission) volume_.readEmission(brick.origin, scratch.emission);
        const double error = encodeTexels(scratch.values, scratch.gradients, valueScale_, format_,
                                          staging.data() + i * voxels * texel.bytes, scratch.emission);
        scratch.error = std::max(scratch.error, error);
      }
    });
    for (std::size_t i = 0; i < count; ++i) {
      const Slot place = slot(brickAndSlot[first + i].first);
      gl_.TextureSubImage3D(textures_[static_cast<std::size_t>(place.texture)].name(), 0, place.origin.x,
                            place.origin.y, place.origin.z, edge.x, edge.y, edge.z, texel.layout, texel.type,
                            staging.data() + i * voxels * texel.bytes);
    }
  }
  uploaded_ += brickAndSlot.size();
  for (const Scratch& scratch : scratches) formatError_ = std::max(formatError_, scratch.error);
  checkGl(gl_, "upload of bricks");
}

}  // namespace umbrick
