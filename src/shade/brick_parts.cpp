// SPDX-License-Identifier: Apache-2.0
#include "shade/brick_parts.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

namespace umbrick {
namespace {

// Makes an array whose axis of `length` numbers, `stride` apart, is replaced by ranges over windows of it: of part i,
// from i * edge on, with `apron` more on both sides.
struct Windows {
  int parts, edge, apron;
};

void narrow(const std::vector<Range>& from, std::size_t outer, int length, std::size_t inner, const Windows& windows,
            std::vector<Range>& to) {
  to.assign(outer * static_cast<std::size_t>(windows.parts) * inner, Range{});
  for (std::size_t o = 0; o < outer; ++o)
    for (int part = 0; part < windows.parts; ++part) {
      Range* const into = &to[(o * static_cast<std::size_t>(windows.parts) + static_cast<std::size_t>(part)) * inner];
      for (int i = part * windows.edge; i < (part + 1) * windows.edge + 2 * windows.apron; ++i) {
        const Range* const row = &from[(o * static_cast<std::size_t>(length) + static_cast<std::size_t>(i)) * inner];
        for (std::size_t k = 0; k < inner; ++k) {
          into[k].min = std::min(into[k].min, row[k].min);
          into[k].max = std::max(into[k].max, row[k].max);
        }
      }
    }
}

}  // namespace

std::size_t BrickParts::Hash::operator()(const glm::ivec3& o) const {
  std::uint64_t hash = 0;
  for (int axis = 0; axis < 3; ++axis)
    hash = (hash ^ static_cast<std::uint32_t>(o[axis])) * std::uint64_t{0x9e3779b97f4a7c15} + (hash >> 29);
  return static_cast<std::size_t>(hash ^ (hash >> 32));
}

BrickParts::BrickParts(const Bricks& volume) : volume_(volume), count_(1) {
  // Reading a part of the volume takes five times its memory: what is as large as this is not divided.
  constexpr std::size_t kMostVoxels = std::size_t{1} << 22;
  if (volume.layout.voxels() > kMostVoxels) return;
  // A lattice of one cell has edges of any length: those are not divided.
  for (int axis = 0; axis < 3; ++axis)
    if (volume.layout.interior[axis] % kEdge == 0) count_[axis] = volume.layout.interior[axis] / kEdge;
}

void BrickParts::measure(std::span<const float> values, std::vector<Range>& ranges) const {
  const glm::ivec3 all = volume_.layout.edge(), part = edge();
  const int apron = volume_.layout.apron;
  std::vector<Range> along(values.size()), next;
  for (std::size_t i = 0; i < values.size(); ++i) along[i] = {values[i], values[i]};
  const auto rows = static_cast<std::size_t>(all.y) * static_cast<std::size_t>(all.z);
  narrow(along, rows, all.x, 1, {count_.x, part.x, apron}, next);
  narrow(next, static_cast<std::size_t>(all.z), all.y, static_cast<std::size_t>(count_.x), {count_.y, part.y, apron},
         along);
  narrow(along, 1, all.z, static_cast<std::size_t>(count_.x) * static_cast<std::size_t>(count_.y),
         {count_.z, part.z, apron}, ranges);
}

std::vector<BrickParts::Ranges> BrickParts::rangesOf(const glm::ivec3& origin) const {
  const std::size_t voxels = volume_.layout.voxels();
  std::vector<float> values(voxels), gradients(volume_.hasGradients ? voxels : 0);
  volume_.read(origin, values, gradients);
  std::vector<Range> ofValues, ofGradients, ofEmission;
  measure(values, ofValues);
  if (volume_.hasGradients) measure(gradients, ofGradients);
  if (volume_.hasEmission) {
    volume_.readEmission(origin, values);
    measure(values, ofEmission);
  }
  std::vector<Ranges> ranges(perBrick());
  for (std::size_t i = 0; i < ranges.size(); ++i)
    ranges[i] = {ofValues[i], volume_.hasGradients ? ofGradients[i] : Range{0, 0},
                 volume_.hasEmission ? ofEmission[i] : Range{0, 0}};
  return ranges;
}

void BrickParts::read(std::span<const glm::ivec3> origins) {
  if (!divides()) return;
  std::vector<std::pair<glm::ivec3, std::vector<Ranges>>> missing;
  for (const glm::ivec3& origin : origins)
    if (!bricks_.contains(origin)) missing.emplace_back(origin, std::vector<Ranges>());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, missing.size()), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) missing[i].second = rangesOf(missing[i].first);
  });
  for (auto& one : missing) bricks_.insert(std::move(one));
}

void BrickParts::each(const glm::ivec3& origin,
                      const std::function<void(std::size_t, const Range&, const Range&, const Range&)>& visit) const {
  const std::vector<Ranges>& ranges = bricks_.at(origin);
  for (std::size_t i = 0; i < ranges.size(); ++i) visit(i, ranges[i].value, ranges[i].gradient, ranges[i].emission);
}

}  // namespace umbrick
