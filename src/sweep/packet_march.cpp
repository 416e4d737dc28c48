// SPDX-License-Identifier: Apache-2.0
#include "sweep/packet_march.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "sweep/ray_clip.h"

namespace umbrick {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMiddleRay = 5;  // one of the four in the middle of a packet

std::int64_t wholeBelow(double at) { return static_cast<std::int64_t>(std::floor(at)); }

}  // namespace

PacketMarch::PacketMarch(const PacketFrame& frame) : frame_(frame) {}

std::uint64_t PacketMarch::march(const std::array<glm::dvec2, kRayGroup>& screen, PacketPixels& pixels,
                                 const PacketDepths* depths) {
  samples_ = 0;
  if (aim(screen)) {
    marchTogether(pixels, depths);
    return samples_;
  }
  // Rays that are far apart, in small pictures of wide views, go one by one.
  for (std::size_t i = 0; i < kRayGroup; ++i) {
    std::array<glm::dvec2, kRayGroup> single;
    single.fill(screen[i]);
    aim(single);
    PacketPixels own;
    PacketDepths depth;
    if (depths) {
      depth.start.fill(depths->start[i]);
      depth.end.fill(depths->end[i]);
    }
    marchTogether(own, depths ? &depth : nullptr);
    pixels.colour[i] = own.colour.front();
    pixels.aux[i] = own.aux.front();
    pixels.emitted[i] = own.emitted.front();
  }
  return samples_;
}

void PacketMarch::marchTogether(PacketPixels& pixels, const PacketDepths* depths) {
  full_ = 0;
  isSampled_ = {};
  for (Lanes* lanes : {&red_, &green_, &blue_, &opacity_, &seen_, &depth_}) lanes->fill(0);
  for (Lanes& lanes : emitted_) lanes.fill(0);
  if (enterBox()) {
    clip(depths);
    if (first_ != last_) marchLayers();
  }
  for (std::size_t i = 0; i < kRayGroup; ++i) {
    pixels.colour[i] = {red_[i], green_[i], blue_[i], opacity_[i]};
    pixels.emitted[i] = {emitted_[0][i], emitted_[1][i], emitted_[2][i]};
    // Depth is linear along a ray: the mean way along n has the mean depth.
    pixels.aux[i] = {seen_[i], 0};
    if (!frame_.aux || !(opacity_[i] > 0)) continue;
    const double n = first_ + sign_ * static_cast<double>(depth_[i] / opacity_[i]);
    const glm::dvec2 across = frame_.perspective ? glm::dvec2(axes_->eye) + exact_[i] * (n - axes_->eye.z)
                                                 : exact_[i] + slope_ * (n - axes_->eye.z);
    pixels.aux[i].y = opacity_[i] * static_cast<float>(glm::dot(axes_->depth, glm::dvec4(across, n, 1)));
  }
}

// Picks the main axis, and describes the rays along it. @return false: some lie too flat in its slices
bool PacketMarch::aim(const std::array<glm::dvec2, kRayGroup>& screen) {
  const auto direction = [&](const PacketAxes& axes, const glm::dvec2& p) {
    return frame_.perspective ? axes.screen[2] + axes.screen[0] * p.x + axes.screen[1] * p.y : axes.screen[2];
  };
  for (const PacketAxes& axes : frame_.axes) {
    const glm::dvec3 along = glm::abs(direction(axes, screen[kMiddleRay]));
    if (along.z >= std::max(along.x, along.y)) axes_ = &axes;
  }
  const glm::dvec3 forward = direction(*axes_, screen[kMiddleRay]);
  sign_ = forward.z > 0 ? 1 : -1;
  slope_ = glm::dvec2(forward) / forward.z;
  for (std::size_t i = 0; i < kRayGroup; ++i) {
    const glm::dvec3 along = direction(*axes_, screen[i]);
    constexpr double kFlattest = 2;  // voxels across, from slice to slice
    if (!(along.z * sign_ * kFlattest >= std::max(std::abs(along.x), std::abs(along.y)))) return false;
    glm::dvec2 slope = glm::dvec2(along) / along.z;
    if (frame_.perspective) {
      exact_[i] = slope;
      placesByDepth_[i] = {axes_->eye.z, along.z};
    } else {
      const glm::dvec3 o = axes_->eye + axes_->screen[0] * screen[i].x + axes_->screen[1] * screen[i].y;
      placesByDepth_[i] = {o.z, along.z};
      exact_[i] = glm::dvec2(o) + slope_ * (axes_->eye.z - o.z);
      slope = slope_;
    }
    const glm::dvec3 perSlice(slope, 1);
    length_[i] = static_cast<float>(std::sqrt(std::max(glm::dot(perSlice, axes_->metric * perSlice), 0.0)));
  }
  middle_ = exact_[kMiddleRay];
  glm::dvec2 least(kInfinity), most(-kInfinity);  // of what rays differ from the middle one
  for (std::size_t i = 0; i < kRayGroup; ++i) {
    const glm::dvec2 across = exact_[i] - middle_;
    least = glm::min(least, across);
    most = glm::max(most, across);
    acrossU_[i] = static_cast<float>(across.x);
    acrossV_[i] = static_cast<float>(across.y);
  }
  for (int across = 0; across < 2; ++across) {
    const auto at = static_cast<std::size_t>(across);
    const double eye = axes_->eye[across], eyeN = axes_->eye.z, middle = middle_[across];
    if (frame_.perspective) {
      // In front of the eye n - eyeN has the sign of the way.
      const double low = middle + (sign_ > 0 ? least : most)[across],
                   high = middle + (sign_ > 0 ? most : least)[across];
      places_[at] = {eye - middle * eyeN, middle};
      bounds_[at] = {eye - low * eyeN, low, eye - high * eyeN, high};
    } else {
      const double start = middle - slope_[across] * eyeN;
      places_[at] = {start, slope_[across]};
      bounds_[at] = {start + least[across], slope_[across], start + most[across], slope_[across]};
    }
  }
  return true;
}

// Finds the part of the way in which some ray may be among what is visible. @return false: there is none
bool PacketMarch::enterBox() {
  const glm::dvec3 &low = axes_->low, &high = axes_->high;
  double near = sign_ > 0 ? low.z : high.z;
  const double far = sign_ > 0 ? high.z : low.z;
  if (frame_.perspective) near = sign_ > 0 ? std::max(near, axes_->eye.z) : std::min(near, axes_->eye.z);
  if ((far - near) * sign_ <= 0) return false;
  // Across, bounds of the rays are linear in n.
  double enter = near, leave = far;
  for (std::size_t across = 0; across < 2; ++across) {
    // Keeps the n where a bound is on the box's side of its face.
    const auto keep = [&](double atNear, double atFar) {
      if (atNear < 0 && atFar < 0) {
        enter = far;
        leave = near;
      } else if (atNear < 0 || atFar < 0) {
        const double n = near + (far - near) * (atNear / (atNear - atFar));
        if (atNear < 0 && (n - enter) * sign_ > 0) enter = n;
        if (atFar < 0 && (leave - n) * sign_ > 0) leave = n;
      }
    };
    const glm::dvec4& b = bounds_[across];
    const double lowest = low[static_cast<int>(across)], highest = high[static_cast<int>(across)];
    keep(b.z + b.w * near - lowest, b.z + b.w * far - lowest);
    keep(highest - (b.x + b.y * near), highest - (b.x + b.y * far));
  }
  if ((leave - enter) * sign_ <= 0) return false;
  // Slices lie at shares of a voxel; the first one is at the eye where that is inside.
  const double per = frame_.perVoxel;
  const auto outwards = [&](double n, double towards) {
    return (towards > 0 ? std::ceil(n * per - kOnVoxels) : std::floor(n * per + kOnVoxels)) / per;
  };
  first_ = outwards(enter, -sign_);
  if (frame_.perspective && (axes_->eye.z - first_) * sign_ > 0) first_ = axes_->eye.z;
  last_ = outwards(leave, sign_);
  return true;
}

void PacketMarch::clip(const PacketDepths* depths) {
  clipped_ = depths || !axes_->planes.empty();
  firstEnter_ = lastEnter_ = 0;
  firstLeave_ = lastLeave_ = std::numeric_limits<float>::max();
  if (!clipped_) return;
  const double way = std::abs(last_ - first_);
  for (std::size_t i = 0; i < kRayGroup; ++i) {
    const double distance = first_ - axes_->eye.z;
    const glm::dvec2 slope = frame_.perspective ? exact_[i] : slope_;
    const glm::dvec2 at = (frame_.perspective ? glm::dvec2(axes_->eye) : exact_[i]) + slope * distance;
    const KeptWay kept = keptWay(axes_->planes, at, first_, slope, sign_, way + 1);
    enter_[i] = kept.enter;
    leave_[i] = kept.leave;
    if (!depths) continue;
    const auto wayTo = [&](double depth) {
      return ((placesByDepth_[i].x + placesByDepth_[i].y * depth) - first_) * sign_;
    };
    // Behind its end a ray has nothing to begin with.
    enter_[i] = std::max(enter_[i], static_cast<float>(std::min(wayTo(depths->start[i]), way + 1)));
    leave_[i] = std::min(leave_[i], static_cast<float>(std::min(wayTo(depths->end[i]), way + 1)));
    leave_[i] = std::max(leave_[i], enter_[i]);
  }
  firstEnter_ = *std::ranges::min_element(enter_);
  lastEnter_ = *std::ranges::max_element(enter_);
  firstLeave_ = *std::ranges::min_element(leave_);
  lastLeave_ = *std::ranges::max_element(leave_);
}

// Goes through layers of groups of cells, and within those that show something from slice to slice.
void PacketMarch::marchLayers() {
  constexpr int kGroup = BrickVoxels::kGroup;
  const BrickTable& table = *frame_.bricks;
  const int edge = frame_.voxels->volume().layout.interior[axes_->n];
  const double per = frame_.perVoxel;
  double at = first_;
  while ((last_ - at) * sign_ > kOnVoxels && !full_) {
    // The cells that the way goes on in.
    const std::int64_t cell = wholeBelow(at + sign_ * 1e-6);
    const std::int64_t brick = table.cellOf(cell, axes_->n), firstOf = table.firstOf(brick, axes_->n);
    const auto until = [&](std::int64_t begin, std::int64_t end) {
      const double n = static_cast<double>(sign_ > 0 ? end : begin);
      return (last_ - n) * sign_ > 0 ? n : last_;
    };
    const double layerEnd = until(firstOf, firstOf + edge);
    if (!hasBricks(at, layerEnd, brick)) {
      at = layerEnd;
      continue;
    }
    const std::int64_t group = (cell - firstOf) / kGroup;
    const double end = until(firstOf + group * kGroup, firstOf + std::min<std::int64_t>((group + 1) * kGroup, edge));
    if (isActive(at, end, group)) {
      while ((end - at) * sign_ > kOnVoxels && !full_) {
        // The next slice is at a share of a voxel.
        const double next =
            (sign_ > 0 ? std::floor(at * per + kOnVoxels) + 1 : std::ceil(at * per - kOnVoxels) - 1) / per;
        const double to = (end - next) * sign_ < 0 ? end : next;
        segment(at, to);
        at = to;
      }
    }
    at = end;
  }
}

bool PacketMarch::hasBricks(double from, double to, std::int64_t cellN) {
  const BrickTable& table = *frame_.bricks;
  const Extent u = extent(0, from, to), v = extent(1, from, to);
  std::array<std::int64_t, 3> cell;
  cell[static_cast<std::size_t>(axes_->n)] = cellN;
  const auto at = [&](double place, int axis) { return table.cellOf(wholeBelow(place), axis); };
  for (std::int64_t j = at(v.low, axes_->v); j <= at(v.high + 1, axes_->v); ++j)
    for (std::int64_t i = at(u.low, axes_->u); i <= at(u.high + 1, axes_->u); ++i) {
      cell[static_cast<std::size_t>(axes_->u)] = i;
      cell[static_cast<std::size_t>(axes_->v)] = j;
      const PlacedBrick* const entry = table.find(cell);
      if (entry && entry->brick) return true;
    }
  return false;
}

// Tells whether groups of cells show something that the rays may meet between two slices of one layer of groups.
bool PacketMarch::isActive(double from, double to, std::int64_t group) {
  if (clipped_) {
    const double begin = std::abs(from - first_), end = std::abs(to - first_);
    if (lastLeave_ <= begin || firstEnter_ >= end) return false;
  }
  constexpr int kGroup = BrickVoxels::kGroup;
  const BrickTable& table = *frame_.bricks;
  const glm::ivec3 groups = frame_.voxels->groups(), interior = frame_.voxels->volume().layout.interior;
  const std::ptrdiff_t strides[3]{1, groups.x, static_cast<std::ptrdiff_t>(groups.x) * groups.y};
  const Extent u = extent(0, from, to), v = extent(1, from, to);
  const std::int64_t u0 = wholeBelow(u.low), u1 = wholeBelow(u.high), v0 = wholeBelow(v.low), v1 = wholeBelow(v.high);
  std::array<std::int64_t, 3> cell;
  cell[static_cast<std::size_t>(axes_->n)] = table.cellOf(wholeBelow(0.5 * (from + to)), axes_->n);
  for (std::int64_t j = table.cellOf(v0, axes_->v); j <= table.cellOf(v1, axes_->v); ++j)
    for (std::int64_t i = table.cellOf(u0, axes_->u); i <= table.cellOf(u1, axes_->u); ++i) {
      cell[static_cast<std::size_t>(axes_->u)] = i;
      cell[static_cast<std::size_t>(axes_->v)] = j;
      const PlacedBrick* const entry = table.find(cell);
      if (!entry || !entry->brick) continue;
      const auto groupOf = [&](std::int64_t voxel, int axis) {
        const std::int64_t offset = voxel - entry->origin[axis];
        return std::clamp<std::int64_t>(offset, 0, interior[axis] - 1) / kGroup;
      };
      const std::uint8_t* const active = entry->brick->active.data() + group * strides[axes_->n];
      for (std::int64_t y = groupOf(v0, axes_->v); y <= groupOf(v1, axes_->v); ++y)
        for (std::int64_t x = groupOf(u0, axes_->u); x <= groupOf(u1, axes_->u); ++x)
          if (active[y * strides[axes_->v] + x * strides[axes_->u]]) return true;
    }
  return false;
}

void PacketMarch::segment(double from, double to) {
  // The back of one segment is the front of the next.
  const int front = isSampled_[0] && sampledAt_[0] == from ? 0 : isSampled_[1] && sampledAt_[1] == from ? 1 : -1;
  const int side = front < 0 ? 0 : front;
  if (front < 0) sample(from, side);
  sample(to, 1 - side);
  RowSegment part = frame_.segment(first_, from, to);
  part.clipped = clipped_ && (lastEnter_ > part.from || firstLeave_ < part.to);
  const RowRays rays{red_.data(),
                     green_.data(),
                     blue_.data(),
                     opacity_.data(),
                     frame_.aux ? seen_.data() : nullptr,
                     frame_.aux ? depth_.data() : nullptr,
                     length_.data(),
                     enter_.data(),
                     leave_.data(),
                     &full_,
                     {emitted_[0].data(), emitted_[1].data(), emitted_[2].data()}};
  std::array<const float*, kMostFields> near{}, far{};
  for (std::size_t field = 0; field < kMostFields; ++field) {
    near[field] = fields_[static_cast<std::size_t>(side)][field].data();
    far[field] = fields_[static_cast<std::size_t>(1 - side)][field].data();
  }
  integrateRows(*frame_.table, part, rays, 0, kRayGroup, near.data(), far.data());
  samples_ += kRayGroup;
}

// Interpolates the fields of all rays on a slice.
void PacketMarch::sample(double n, int side) {
  const BrickVoxels& voxels = *frame_.voxels;
  const MediumTable& table = *frame_.table;
  const BrickLayout& layout = voxels.volume().layout;
  const glm::ivec3 edge = layout.edge();
  const std::ptrdiff_t strides[3]{1, edge.x, static_cast<std::ptrdiff_t>(edge.x) * edge.y};
  sampledAt_[static_cast<std::size_t>(side)] = n;
  isSampled_[static_cast<std::size_t>(side)] = true;
  auto& fields = fields_[static_cast<std::size_t>(side)];
  fields[0].fill(frame_.classified ? 0 : static_cast<float>(table.stepsOf(voxels.volume().background)));
  for (int c = 0; frame_.classified && c < 3; ++c) fields[static_cast<std::size_t>(kColourFields + c)].fill(0);
  if (table.is2d()) fields[1].fill(static_cast<float>(table.gradientStepsOf(0)));
  if (frame_.emission)
    fields[kEmissionField].fill(static_cast<float>(frame_.emission->stepsOf(voxels.volume().emissionBackground)));
  // Where no brick is held nothing is seen: light there is that of the slice before.
  if (frame_.lights > 0) {
    const auto& other = fields_[static_cast<std::size_t>(1 - side)];
    for (int c = 0; c < frame_.lights; ++c)
      if (isSampled_[static_cast<std::size_t>(1 - side)])
        fields[static_cast<std::size_t>(2 + c)] = other[static_cast<std::size_t>(2 + c)];
      else
        fields[static_cast<std::size_t>(2 + c)].fill(1);
  }
  PacketSlice slice;
  slice.code = voxels.code();
  slice.strideU = strides[axes_->u];
  slice.strideV = strides[axes_->v];
  slice.strideN = strides[axes_->n];
  const double u = middleAt(0, n), v = middleAt(1, n);
  baseU_ = wholeBelow(u);
  baseV_ = wholeBelow(v);
  slice.u = static_cast<float>(u - static_cast<double>(baseU_));
  slice.v = static_cast<float>(v - static_cast<double>(baseV_));
  slice.spread = static_cast<float>(spreadAt(n));
  double whole = std::floor(n), share = n - whole;
  if (share > 1 - kOnVoxels) {
    ++whole;
    share = 0;
  }
  slice.n = share < kOnVoxels ? 0 : static_cast<float>(share);
  const bool codes = !isFloat(voxels.code());
  slice.bias = codes ? 0 : static_cast<float>(table.origin());
  slice.factor = static_cast<float>(table.perUnit());
  slice.first = static_cast<float>(codes ? table.stepsOf(voxels.offset()) : table.first());
  if (frame_.emission) {
    slice.emits = true;
    slice.emissionBias = static_cast<float>(frame_.emission->origin());
    slice.emissionFactor = static_cast<float>(frame_.emission->perUnit());
    slice.emissionFirst = static_cast<float>(frame_.emission->first());
  }
  slice.classified = frame_.classified;
  slice.gradients = table.is2d();
  slice.gradientFactor = static_cast<float>(table.gradientPerUnit());
  slice.gradientFirst = static_cast<float>(table.gradientStepsOf(0));
  slice.lights = frame_.lights;
  slice.lightUnit = frame_.lightUnit;
  slice.lightStride = static_cast<std::ptrdiff_t>(layout.voxels());
  cellsU_ = extent(0, n, n);
  cellsV_ = extent(1, n, n);
  bricks_.clear();
  const auto n0 = static_cast<std::int64_t>(whole);
  const BrickTable& cells = *frame_.bricks;
  const std::int64_t own = cells.cellOf(n0, axes_->n), first = cells.firstOf(own, axes_->n);
  // Neighbours along n see the slice among their ghosts.
  if (slice.n == 0 && n0 == first) addBricks(n0, own - 1, listed_[0]);
  if (n0 == first + layout.interior[axes_->n] - 1) addBricks(n0, own + 1, listed_[1]);
  addBricks(n0, own, listed_[2]);
  std::array<float*, kMostFields> out{};
  for (std::size_t field = 0; field < kMostFields; ++field) out[field] = fields[field].data();
  samplePacket(slice, bricks_, acrossU_.data(), acrossV_.data(), out.data());
}

// Lists the bricks of a layer that rays are in, those that are held last, so that their voxels count.
void PacketMarch::addBricks(std::int64_t n, std::int64_t layer, Listed& listed) {
  const BrickTable& table = *frame_.bricks;
  const BrickLayout& layout = frame_.voxels->volume().layout;
  const glm::ivec3 edge = layout.edge();
  const std::ptrdiff_t strides[3]{1, edge.x, static_cast<std::ptrdiff_t>(edge.x) * edge.y};
  const auto cellAt = [&](double place, std::int64_t more, int axis) {
    return table.cellOf(wholeBelow(place) + more, axis);
  };
  // A float's rounding may bring a ray into the cell beside its own.
  const std::array<std::int64_t, 5> cells{
      cellAt(cellsU_.low - 1e-4, 0, axes_->u), cellAt(cellsU_.high + 1e-4, 1, axes_->u),
      cellAt(cellsV_.low - 1e-4, 0, axes_->v), cellAt(cellsV_.high + 1e-4, 1, axes_->v), layer};
  if (listed.axis != axes_->n || listed.cells != cells) {
    listed.axis = axes_->n;
    listed.cells = cells;
    listed.entries.clear();
    std::array<std::int64_t, 3> cell;
    cell[static_cast<std::size_t>(axes_->n)] = layer;
    for (std::int64_t j = cells[2]; j <= cells[3]; ++j)
      for (std::int64_t i = cells[0]; i <= cells[1]; ++i) {
        cell[static_cast<std::size_t>(axes_->u)] = i;
        cell[static_cast<std::size_t>(axes_->v)] = j;
        const PlacedBrick* const entry = table.find(cell);
        if (entry) listed.entries.insert(entry->brick ? listed.entries.end() : listed.entries.begin(), entry);
      }
  }
  for (const PlacedBrick* const entry : listed.entries) {
    PacketBrick brick;
    const auto firstU = static_cast<std::int32_t>(entry->origin[axes_->u] - baseU_);
    const auto firstV = static_cast<std::int32_t>(entry->origin[axes_->v] - baseV_);
    brick.endU = firstU + layout.interior[axes_->u];
    brick.endV = firstV + layout.interior[axes_->v];
    // With the cells that begin at the ghosts before the brick.
    brick.firstU = firstU - (entry->brick != nullptr);
    brick.firstV = firstV - (entry->brick != nullptr);
    if (entry->brick) {
      const VoxelBrick& held = *entry->brick;
      brick.voxels = held.voxels.get();
      brick.gradients = held.gradients.get();
      brick.light = held.light.get();
      brick.media = held.media.get();
      brick.emission = held.emission.get();
      if (frame_.emission) brick.emissionValue = static_cast<float>(frame_.emission->stepsOf(held.emissionRange.min));
      brick.value = static_cast<float>(frame_.table->stepsOf(held.value.min));
      brick.first = (layout.apron - 1) * (strides[axes_->u] + strides[axes_->v]) +
                    (n - entry->origin[axes_->n] + layout.apron) * strides[axes_->n];
    } else {
      brick.value = static_cast<float>(frame_.table->stepsOf(entry->value));
      if (frame_.emission) brick.emissionValue = static_cast<float>(frame_.emission->stepsOf(entry->emission));
    }
    bricks_.push_back(brick);
  }
}

}  // namespace umbrick
