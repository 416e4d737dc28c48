// SPDX-License-Identifier: Apache-2.0
#include "sweep/brick_rows.h"

#include <cmath>
#include <limits>
#include <tuple>

#include "umbrick/core/memory.h"

namespace umbrick {
BrickRows::BrickRows(const BrickVoxels& voxels, const RayLattice& axes)
    : voxels_(voxels), u_(axes.u), v_(axes.v), n_(axes.n) {
  const glm::ivec3 interior = voxels.volume().layout.interior;
  const auto permuted = [&](const glm::ivec3& p) { return glm::ivec3(p[u_], p[v_], p[n_]); };
  interior_ = permuted(interior);
  struct Placed {
    glm::ivec3 first;
    RowBrick brick;
  };
  std::vector<Placed> placed;
  bool any = false;
  for (const PlacedBrick& one : voxels.allBricks()) {
    const glm::ivec3 first = permuted(one.origin);
    placed.push_back({first, {first.x, one.brick, one.value}});
    if (!one.brick) continue;
    low_ = any ? glm::min(low_, first) : first;
    high_ = any ? glm::max(high_, first + interior_) : first + interior_;
    any = true;
  }
  const auto comesBefore = [](const glm::ivec3& a, const glm::ivec3& b) {
    return std::tuple(a.z, a.y, a.x) < std::tuple(b.z, b.y, b.x);
  };
  if (placed.empty()) return;
  std::ranges::sort(placed, comesBefore, &Placed::first);
  glm::ivec3 last = placed.front().first;
  base_ = last;
  for (const Placed& one : placed) {
    base_ = glm::min(base_, one.first);
    last = glm::max(last, one.first);
  }
  rowsV_ = (static_cast<std::int64_t>(last.y) - base_.y) / interior_.y + 1;
  rowsN_ = (static_cast<std::int64_t>(last.z) - base_.z) / interior_.z + 1;
  const glm::ivec3 groups = voxels.groups();
  requireMemory("shear-warp: a table of rows of bricks", sizeof(std::uint32_t) * static_cast<double>(rowsV_) *
                                                             static_cast<double>(rowsN_) *
                                                             (1 + static_cast<double>(groups[v_]) * groups[n_]));
  start_.assign(static_cast<std::size_t>(rowsV_ * rowsN_) + 1, 0);
  for (const Placed& one : placed) {
    const std::int64_t row =
        cellOf(one.first.z, base_.z, interior_.z) * rowsV_ + cellOf(one.first.y, base_.y, interior_.y);
    ++start_[static_cast<std::size_t>(row) + 1];
    bricks_.push_back(one.brick);
  }
  for (std::size_t row = 1; row < start_.size(); ++row) start_[row] += start_[row - 1];
  collectActive();
}

void BrickRows::collectActive() {
  const glm::ivec3 groups = voxels_.groups();
  const std::ptrdiff_t strides[3]{1, groups.x, static_cast<std::ptrdiff_t>(groups.x) * groups.y};
  activeStart_.push_back(0);
  for (std::size_t row = 0; row + 1 < start_.size(); ++row)
    for (int n = 0; n < groups[n_]; ++n)
      for (int v = 0; v < groups[v_]; ++v) {
        const std::size_t first = active_.size();
        for (std::uint32_t i = start_[row]; i < start_[row + 1]; ++i) {
          if (!bricks_[i].brick) continue;
          const std::uint8_t* active = bricks_[i].brick->active.data() + v * strides[v_] + n * strides[n_];
          for (int u = 0; u < groups[u_]; ++u, active += strides[u_]) {
            if (!*active) continue;
            // Cells that end at a brick's first owned voxel are its own, too.
            const std::int32_t begin = bricks_[i].first + u * BrickVoxels::kGroup - (u == 0);
            const std::int32_t end = bricks_[i].first + std::min((u + 1) * BrickVoxels::kGroup, interior_.x);
            if (active_.size() > first && begin <= active_.back().end)
              active_.back().end = end;
            else
              active_.push_back({begin, end});
          }
        }
        activeStart_.push_back(static_cast<std::uint32_t>(active_.size()));
      }
}

std::span<const BrickRows::Cells> BrickRows::activeCells(std::int64_t v, std::int64_t n) const {
  const std::int64_t row = cellOf(v, base_.y, interior_.y), layer = cellOf(n, base_.z, interior_.z);
  if (row < 0 || row >= rowsV_ || layer < 0 || layer >= rowsN_) return {};
  const glm::ivec3 groups = voxels_.groups();
  const std::int64_t groupV = (v - base_.y - row * interior_.y) / BrickVoxels::kGroup;
  const std::int64_t groupN = (n - base_.z - layer * interior_.z) / BrickVoxels::kGroup;
  const auto at = static_cast<std::size_t>(((layer * rowsV_ + row) * groups[n_] + groupN) * groups[v_] + groupV);
  return std::span(active_).subspan(activeStart_[at], activeStart_[at + 1] - activeStart_[at]);
}

std::span<const RowBrick> BrickRows::at(std::int64_t v, std::int64_t n) const {
  const std::int64_t row = cellOf(v, base_.y, interior_.y), layer = cellOf(n, base_.z, interior_.z);
  if (row < 0 || row >= rowsV_ || layer < 0 || layer >= rowsN_) return {};
  const auto at = static_cast<std::size_t>(layer * rowsV_ + row);
  return std::span(bricks_).subspan(start_[at], start_[at + 1] - start_[at]);
}

RowReader::RowReader(const BrickVoxels& voxels, const BrickRows& rows, const RayLattice& axes, const MediumTable& table,
                     int lights, float lightUnit, bool classified)
    : voxels_(voxels),
      rows_(rows),
      table_(table),
      u_(axes.u),
      v_(axes.v),
      n_(axes.n),
      lights_(lights),
      lightUnit_(lightUnit),
      empty_(classified ? 0 : static_cast<float>(table.stepsOf(voxels.volume().background))),
      classified_(classified) {}

void RowReader::read(double v, double n, std::int64_t begin, std::int64_t end) {
  begin_ = begin;
  end_ = end;
  for (int field = 0; field < kMostFields; ++field)
    if (has(field))
      buffers_[static_cast<std::size_t>(field)].resize(static_cast<std::size_t>(end - begin) + 2 * kRowPadding);
  Place place;
  const auto split = [](double at, std::int64_t& whole, float& share) {
    double floor = std::floor(at);
    double rest = at - floor;
    if (rest > 1 - kOnVoxels) {
      ++floor;
      rest = 0;
    }
    whole = static_cast<std::int64_t>(floor);
    share = rest < kOnVoxels ? 0 : static_cast<float>(rest);
  };
  split(v, place.v, place.shareV);
  split(n, place.n, place.shareN);
  // What is between the bricks and in those that are not held first: bricks write over it as far as their ghosts reach.
  std::int64_t next = begin;
  bool complete = true;
  const std::span<const RowBrick> own = rows_.at(place.v, place.n);
  const std::int64_t edge = rows_.interior().x;
  std::fill_n(buffers_[0].begin(), end - begin + kRowPadding, empty_);
  for (const RowBrick& at : own) {
    if (at.first + edge <= begin) continue;
    if (at.first >= end) break;
    complete = complete && at.first <= next;
    next = at.first + edge;
    if (at.brick) continue;
    complete = false;
    const std::int64_t from = std::max<std::int64_t>(at.first, begin),
                       to = std::min<std::int64_t>(at.first + edge, end);
    if (!classified_)
      std::fill_n(buffers_[0].begin() + (from - begin), to - from, static_cast<float>(table_.stepsOf(at.value)));
  }
  complete = complete && next >= end;
  for (int c = 0; classified_ && c < 3; ++c)
    std::fill_n(buffers_[static_cast<std::size_t>(kColourFields + c)].begin(), end - begin + kRowPadding, 0.0f);
  if (has(1))
    std::fill_n(buffers_[1].begin(), end - begin + kRowPadding, static_cast<float>(table_.gradientStepsOf(0)));
  for (int c = 0; c < lights_; ++c)
    std::fill_n(buffers_[static_cast<std::size_t>(2 + c)].begin(), end - begin + kRowPadding, -1.0f);
  const std::int64_t firstV = rows_.firstV(place.v), firstN = rows_.firstN(place.n);
  const glm::ivec3 interior = rows_.interior();
  if (!complete) {
    // Where the brick that owns the row is not held, a neighbour may see the row among its ghosts: the one behind it
    // along v or n from the last own voxel on, the one before it on its first slice.
    const bool lastV = place.v == firstV + interior.y - 1, lastN = place.n == firstN + interior.z - 1;
    const bool firstSlice = place.n == firstN && place.shareN == 0;
    const auto readBeside = [&](std::int64_t stepV, std::int64_t stepN) {
      const std::int64_t besideV = firstV + stepV * interior.y, besideN = firstN + stepN * interior.z;
      for (const RowBrick& at : rows_.at(besideV, besideN))
        if (at.brick && at.first < end && at.first + edge > begin) readBrick(at, place, besideV, besideN);
    };
    if (lastV && lastN) readBeside(1, 1);
    if (lastV && firstSlice) readBeside(1, -1);
    if (lastV) readBeside(1, 0);
    if (lastN) readBeside(0, 1);
    if (firstSlice) readBeside(0, -1);
  }
  for (const RowBrick& at : own)
    if (at.brick && at.first < end && at.first + edge > begin) readBrick(at, place, firstV, firstN);
  if (lights_ > 0) spreadLight();
}

void RowReader::readBrick(const RowBrick& at, const Place& place, std::int64_t firstV, std::int64_t firstN) {
  const BrickLayout& layout = voxels_.volume().layout;
  const glm::ivec3 edge = layout.edge();
  const std::ptrdiff_t strides[3]{1, edge.x, static_cast<std::ptrdiff_t>(edge.x) * edge.y};
  // With the ghosts on both sides.
  const std::int64_t from = std::max<std::int64_t>(at.first - 1, begin_);
  const std::int64_t to = std::min<std::int64_t>(at.first + rows_.interior().x + 1, end_);
  if (from >= to) return;
  const auto count = static_cast<int>(to - from);
  const VoxelBrick& brick = *at.brick;
  const std::ptrdiff_t offset = (from - at.first + layout.apron) * strides[u_] +
                                (place.v - firstV + layout.apron) * strides[v_] +
                                (place.n - firstN + layout.apron) * strides[n_];
  // The second rows are not looked at where they have no share, and may not be there.
  const std::ptrdiff_t nextV = place.shareV > 0 ? strides[v_] : 0, nextN = place.shareN > 0 ? strides[n_] : 0;
  VoxelRows rows;
  rows.stride = strides[u_];
  rows.v = place.shareV;
  rows.n = place.shareN;
  const auto blendFrom = [&](const auto* codes, VoxelCode code, float* out) {
    const auto* first = codes + offset;
    rows.rows = {first, first + nextV, first + nextN, first + nextV + nextN};
    // A whole vector is written at a time: what lies behind has to be brought back.
    float behind[kRayGroup];
    std::copy_n(out + count, kRayGroup, behind);
    blendRows(code, rows, count, out);
    std::copy_n(behind, kRayGroup, out + count);
  };
  if (classified_) {
    for (int c = 0; brick.media && c < kMediumNumbers; ++c) {
      const auto field = static_cast<std::size_t>(c == 0 ? 0 : kColourFields + c - 1);
      blendFrom(static_cast<const float*>(brick.media.get()) + static_cast<std::ptrdiff_t>(layout.voxels()) * c,
                VoxelCode::f32, buffers_[field].data() + (from - begin_));
    }
    return;
  }
  float* const values = buffers_[0].data() + (from - begin_);
  if (!brick.voxels) {
    std::fill_n(values, count, static_cast<float>(table_.stepsOf(brick.value.min)));
  } else {
    const bool whole = !isFloat(voxels_.code());
    rows.bias = whole ? 0 : static_cast<float>(table_.origin());
    rows.factor = static_cast<float>(table_.perUnit());
    rows.first = static_cast<float>(whole ? table_.stepsOf(voxels_.offset()) : table_.first());
    if (voxels_.code() == VoxelCode::u8) blendFrom(BrickVoxels::codes<std::uint8_t>(brick), VoxelCode::u8, values);
    if (voxels_.code() == VoxelCode::u16) blendFrom(BrickVoxels::codes<std::uint16_t>(brick), VoxelCode::u16, values);
    if (voxels_.code() == VoxelCode::f16) blendFrom(BrickVoxels::codes<HalfCode>(brick), VoxelCode::f16, values);
    if (voxels_.code() == VoxelCode::f32) blendFrom(BrickVoxels::codes<float>(brick), VoxelCode::f32, values);
  }
  if (has(1) && brick.gradients) {
    rows.bias = 0;
    rows.factor = static_cast<float>(table_.gradientPerUnit());
    rows.first = static_cast<float>(table_.gradientStepsOf(0));
    blendFrom(static_cast<const float*>(brick.gradients.get()), VoxelCode::f32, buffers_[1].data() + (from - begin_));
  }
  for (int c = 0; c < lights_; ++c) {
    float* const out = buffers_[static_cast<std::size_t>(2 + c)].data() + (from - begin_);
    if (!brick.light) {
      std::fill_n(out, count, 1.0f);
      continue;
    }
    rows.bias = 0;
    rows.factor = lightUnit_;
    rows.first = 0;
    const auto plane = static_cast<std::ptrdiff_t>(layout.voxels()) * c;
    blendFrom(static_cast<const std::uint16_t*>(brick.light.get()) + plane, VoxelCode::u16, out);
  }
}

// Where no brick is held no light is known, and nothing is seen: light goes on as it is beside it.
void RowReader::spreadLight() {
  for (int c = 0; c < lights_; ++c) {
    float* const light = buffers_[static_cast<std::size_t>(2 + c)].data();
    const std::int64_t count = end_ - begin_;
    float known = -1;
    for (std::int64_t i = 0; i < count; ++i) {
      if (light[i] >= 0) {
        if (known < 0) std::fill_n(light, i, light[i]);
        known = light[i];
      } else if (known >= 0) {
        // Half of a gap is nearer to its other side.
        std::int64_t end = i;
        while (end < count && light[end] < 0) ++end;
        const float other = end < count ? light[end] : known;
        const std::int64_t half = i + (end - i) / 2;
        std::fill(light + i, light + half, known);
        std::fill(light + half, light + end, other);
        i = end - 1;
      }
    }
    std::fill_n(light + (known < 0 ? 0 : count), known < 0 ? count + kRowPadding : kRowPadding, std::max(known, 0.0f));
  }
}

}  // namespace umbrick
