// SPDX-License-Identifier: Apache-2.0
#include "sweep/brick_voxels.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <type_traits>

#include "umbrick/core/error.h"
#include "umbrick/core/memory.h"

namespace umbrick {
namespace {

std::tuple<int, int, int> orderOf(const glm::ivec3& origin) { return {origin.z, origin.y, origin.x}; }

template <class Code>
Code codeOf(float value) {
  if constexpr (std::is_same_v<Code, HalfCode>)
    return {glm::packHalf1x16(value)};  // exact, as all voxels are halves
  else
    return static_cast<Code>(value);
}

std::size_t bytesOf(VoxelCode code) { return code == VoxelCode::u8 ? 1 : code == VoxelCode::f32 ? sizeof(float) : 2; }

}  // namespace

float halfValue(HalfCode code) { return glm::unpackHalf1x16(code.bits); }

BrickVoxels::BrickVoxels(const Bricks& volume, bool halves) : volume_(volume) {
  if (volume.exactFormat == VoxelFormat::unorm8) code_ = VoxelCode::u8;
  if (volume.exactFormat == VoxelFormat::unorm16) code_ = VoxelCode::u16;
  if (halves && volume.exactFormat == VoxelFormat::half) code_ = VoxelCode::f16;
  if (!isFloat(code_)) offset_ = volume.value.min;
  groups_ = (volume.layout.interior + kGroup - 1) / kGroup;
}

std::vector<Brick> BrickVoxels::visible(const ShownValues& shown, bool culling, bool backgroundVisible) const {
  std::vector<Brick> bricks;
  const auto isVisible = [&](const Brick& brick) {
    return !culling || shown.shows(brick.value, brick.gradient, brick.emission);
  };
  std::ranges::copy_if(volume_.bricks, std::back_inserter(bricks), isVisible);
  if (backgroundVisible) std::ranges::copy(backgroundBricks(volume_), std::back_inserter(bricks));
  std::ranges::sort(bricks, {}, [](const Brick& brick) { return orderOf(brick.origin); });
  return bricks;
}

std::uint64_t BrickVoxels::bytesEach(bool gradients, bool emission) const {
  return volume_.layout.voxels() *
         (umbrick::bytesOf(code_) + (gradients ? sizeof(float) : 0) + (emission ? sizeof(float) : 0));
}

std::uint64_t BrickVoxels::bytesOf(std::span<const Brick> bricks, bool gradients, bool emission) const {
  // Those of 2D functions are read for their gradients.
  const auto held = static_cast<std::uint64_t>(
      std::ranges::count_if(bricks, [&](const Brick& brick) { return gradients || !brick.uniform(); }));
  const auto emitting = static_cast<std::uint64_t>(std::ranges::count_if(
      bricks, [&](const Brick& brick) { return emission && brick.emission.min != brick.emission.max; }));
  return held * bytesEach(gradients) + emitting * volume_.layout.voxels() * sizeof(float);
}

void BrickVoxels::hold(std::span<const Brick> wanted, const ShownValues& shown, bool culling, bool makeRoom) {
  if (makeRoom) {
    std::erase_if(bricks_, [&](const auto& held) {
      return !std::ranges::binary_search(wanted, orderOf(held->origin), {},
                                         [](const Brick& brick) { return orderOf(brick.origin); });
    });
    ++generation_;
  }
  read(wanted, shown.medium.is2d(), shown.emission != nullptr);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, bricks_.size(), 4), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) activate(*bricks_[i], shown, culling);
  });
}

void BrickVoxels::select(const std::function<bool(const Range& value)>& isWanted, std::uint64_t mostBytes) {
  std::vector<Brick> wanted;
  std::ranges::copy_if(volume_.bricks, std::back_inserter(wanted), [&](const Brick& b) { return isWanted(b.value); });
  std::ranges::sort(wanted, {}, [](const Brick& brick) { return orderOf(brick.origin); });
  const std::uint64_t needed = bytesOf(wanted, false);
  if (needed > mostBytes)
    throw InvalidArgument("bricks.budgetMiB: the voxels of " + std::to_string(wanted.size()) + " bricks take " +
                          std::to_string((needed >> 20) + 1) + " MiB, more than " + std::to_string(mostBytes >> 20) +
                          " MiB");
  read(wanted, false, false);
  for (const auto& brick : bricks_) {
    brick->active.assign(groupCount(), 1);
    if (!brick->ranges) continue;
    for (std::size_t i = 0; i < brick->active.size(); ++i)
      brick->active[i] = isWanted({brick->ranges[2 * i], brick->ranges[2 * i + 1]});
  }
}

void BrickVoxels::read(std::span<const Brick> wanted, bool gradients, bool emission) {
  requireMemory("the voxels of " + std::to_string(wanted.size()) + " visible bricks",
                static_cast<double>(bytesOf(wanted, gradients, emission)));
  // What is missing is read aside: where that fails, nothing has changed.
  std::map<std::tuple<int, int, int>, std::size_t> before;
  for (std::size_t i = 0; i < bricks_.size(); ++i)
    // Gradients and emission are read with the voxels.
    if ((!gradients || bricks_[i]->gradients) && (!emission || bricks_[i]->readEmission))
      before[orderOf(bricks_[i]->origin)] = i;
  std::vector<std::unique_ptr<VoxelBrick>> next(wanted.size());
  std::vector<std::pair<std::size_t, std::size_t>> kept;  // places in `next` and in bricks_
  std::vector<VoxelBrick*> missing;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto found = before.find(orderOf(wanted[i].origin));
    if (found != before.end()) {
      kept.emplace_back(i, found->second);
      continue;
    }
    next[i] = std::make_unique<VoxelBrick>();
    next[i]->origin = wanted[i].origin;
    next[i]->value = wanted[i].value;
    next[i]->gradient = wanted[i].gradient;
    next[i]->emissionRange = wanted[i].emission;
    next[i]->readEmission = emission;
    missing.push_back(next[i].get());
  }
  tbb::enumerable_thread_specific<std::vector<float>> scratches;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, missing.size(), 1), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      if (gradients)
        missing[i]->gradients = std::make_unique_for_overwrite<float[]>(volume_.layout.voxels() + kPadding);
      load(*missing[i], scratches.local());
      loadEmission(*missing[i]);
      missing[i]->active.resize(groupCount());
    }
  });
  for (const auto& [place, old] : kept) next[place] = std::move(bricks_[old]);
  bricks_ = std::move(next);
  ++generation_;
  loaded_ = missing.size();
}

std::vector<PlacedBrick> BrickVoxels::allBricks() const {
  std::vector<PlacedBrick> all;
  all.reserve(volume_.bricks.size() + bricks_.size());
  for (const auto& brick : bricks_) all.push_back({brick->origin, brick.get()});
  for (const Brick& brick : volume_.bricks)
    if (!std::ranges::binary_search(bricks_, orderOf(brick.origin), {},
                                    [](const auto& held) { return orderOf(held->origin); }))
      all.push_back({brick.origin, nullptr, 0.5f * (brick.value.min + brick.value.max),
                     0.5f * (brick.emission.min + brick.emission.max)});
  return all;
}

std::size_t BrickVoxels::groupCount() const {
  return static_cast<std::size_t>(groups_.x) * static_cast<std::size_t>(groups_.y) *
         static_cast<std::size_t>(groups_.z);
}

void BrickVoxels::load(VoxelBrick& brick, std::vector<float>& values) const {
  if (brick.value.min == brick.value.max && !brick.gradients) return;
  values.resize(volume_.layout.voxels());
  const std::span<float> gradients(brick.gradients.get(), brick.gradients ? values.size() : 0);
  volume_.read(brick.origin, values, gradients);
  brick.ranges = rangesOf(values);
  if (code_ == VoxelCode::u8) store<std::uint8_t>(brick, values);
  if (code_ == VoxelCode::u16) store<std::uint16_t>(brick, values);
  if (code_ == VoxelCode::f16) store<HalfCode>(brick, values);
  if (code_ == VoxelCode::f32) store<float>(brick, values);
}

void BrickVoxels::loadEmission(VoxelBrick& brick) const {
  if (!brick.readEmission || brick.emissionRange.min == brick.emissionRange.max) return;
  const std::size_t voxels = volume_.layout.voxels();
  brick.emission = std::make_unique_for_overwrite<float[]>(voxels + kPadding);
  const std::span<float> values(brick.emission.get(), voxels);
  volume_.readEmission(brick.origin, values);
  brick.emissionRanges = rangesOf(values);
}

template <class Code>
void BrickVoxels::store(VoxelBrick& brick, std::span<const float> values) const {
  // Some more bytes behind the last voxel let several be read at once.
  brick.voxels = std::make_unique_for_overwrite<std::byte[]>((values.size() + kPadding) * sizeof(Code));
  auto* const codes = reinterpret_cast<Code*>(brick.voxels.get());
  const auto offset = static_cast<float>(offset_);
  for (std::size_t i = 0; i < values.size(); ++i) codes[i] = codeOf<Code>(values[i] - offset);
}

// Returns the range of the voxels of each group of cells.
std::unique_ptr<float[]> BrickVoxels::rangesOf(std::span<const float> values) const {
  const glm::ivec3 edge = volume_.layout.edge();
  const int apron = volume_.layout.apron;
  const std::size_t count = groupCount();
  auto ranges = std::make_unique_for_overwrite<float[]>(2 * count);
  float* next = ranges.get();
  // A group's first and last voxel along an axis, the corners of its last cells included.
  const auto first = [&](int group) { return group == 0 ? apron - 1 : apron + group * kGroup; };
  const auto last = [&](int group, int interior) { return apron + std::min((group + 1) * kGroup, interior); };
  for (int gz = 0; gz < groups_.z; ++gz)
    for (int gy = 0; gy < groups_.y; ++gy)
      for (int gx = 0; gx < groups_.x; ++gx, next += 2) {
        float low = std::numeric_limits<float>::infinity(), high = -low;
        for (int z = first(gz); z <= last(gz, volume_.layout.interior.z); ++z)
          for (int y = first(gy); y <= last(gy, volume_.layout.interior.y); ++y) {
            const float* row = values.data() + (static_cast<std::ptrdiff_t>(z) * edge.y + y) * edge.x;
            for (int x = first(gx); x <= last(gx, volume_.layout.interior.x); ++x) {
              low = std::min(low, row[x]);
              high = std::max(high, row[x]);
            }
          }
        next[0] = low;
        next[1] = high;
      }
  return ranges;
}

void BrickVoxels::activate(VoxelBrick& brick, const ShownValues& shown, bool culling) const {
  const std::size_t count = groupCount();
  brick.active.assign(count, 1);
  if (!culling || (!brick.ranges && !brick.emissionRanges)) return;
  const auto rangeOf = [](const std::unique_ptr<float[]>& ranges, std::size_t i, const Range& all) {
    return ranges ? Range{ranges[2 * i], ranges[2 * i + 1]} : all;
  };
  for (std::size_t i = 0; i < count; ++i)
    brick.active[i] = shown.shows(rangeOf(brick.ranges, i, brick.value), brick.gradient,
                                  rangeOf(brick.emissionRanges, i, brick.emissionRange));
}

std::uint64_t BrickVoxels::bytes() const {
  const std::uint64_t voxels = volume_.layout.voxels();
  std::uint64_t sum = 0;
  for (const auto& brick : bricks_) {
    if (brick->voxels) sum += voxels * umbrick::bytesOf(code_);
    if (brick->gradients) sum += voxels * sizeof(float);
    if (brick->emission) sum += voxels * sizeof(float);
    if (brick->media) sum += voxels * kMediumNumbers * sizeof(float);
    if (brick->light) sum += voxels * sizeof(std::uint16_t);
    sum += brick->active.size() * (1 + (brick->ranges ? 2 * sizeof(float) : 0));
  }
  return sum;
}

}  // namespace umbrick
