// SPDX-License-Identifier: Apache-2.0
#include "sweep/projection_march.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "sweep/voxel_point.h"

namespace umbrick {
namespace {

constexpr std::array<std::array<int, 2>, 3> kAcross{{{1, 2}, {0, 2}, {0, 1}}};

std::int64_t cellBelow(double at) { return static_cast<std::int64_t>(std::floor(at)); }

}  // namespace

void ProjectionMarch::march(const Rays& rays, Values& values) {
  if (aim(rays)) return marchTogether(values);
  // Rays that are far apart, in small pictures of wide views, go one by one.
  for (std::size_t i = 0; i < kRayGroup; ++i) {
    Rays single;
    single.fill(rays[i]);
    Values own;
    aim(single);
    marchTogether(own);
    values[i] = own.front();
  }
}

// Picks the main axis, and describes the rays along it. @return false: some lie too flat in its slices
bool ProjectionMarch::aim(const Rays& rays) {
  for (std::size_t i = 0; i < kRayGroup; ++i) valid_[i] = !rays[i].empty();
  constexpr std::size_t kMiddleRay = 5;  // one of the four in the middle of a packet
  const auto first = static_cast<std::size_t>(std::ranges::find(valid_, true) - valid_.begin());
  if (first == kRayGroup) return true;
  const std::size_t middle = valid_[kMiddleRay] ? kMiddleRay : first;
  const glm::dvec3 along = glm::abs(rays[middle].direction);
  n_ = along.z >= std::max(along.x, along.y) ? 2 : along.y >= along.x ? 1 : 0;
  u_ = kAcross[static_cast<std::size_t>(n_)][0];
  v_ = kAcross[static_cast<std::size_t>(n_)][1];
  const double sign = rays[middle].direction[n_] > 0 ? 1 : -1;
  constexpr double kFlattest = 2;  // voxels across, from slice to slice
  for (std::size_t i = 0; i < kRayGroup; ++i) {
    if (!valid_[i]) continue;
    const glm::dvec3 &from = rays[i].origin, &way = rays[i].direction;
    if (!(way[n_] * sign * kFlattest >= std::max(std::abs(way[u_]), std::abs(way[v_])))) return false;
    slopeU_[i] = way[u_] / way[n_];
    slopeV_[i] = way[v_] / way[n_];
    u0_[i] = from[u_] - slopeU_[i] * from[n_];
    v0_[i] = from[v_] - slopeV_[i] * from[n_];
    const double a = rays[i].at(rays[i].enter)[n_], b = rays[i].at(rays[i].leave)[n_];
    low_[i] = std::clamp<double>(std::min(a, b), frame_.box.min[n_], frame_.box.max[n_]);
    high_[i] = std::clamp<double>(std::max(a, b), frame_.box.min[n_], frame_.box.max[n_]);
    first_[i] = std::ceil(low_[i] * frame_.perVoxel - kOnVoxels);
    last_[i] = std::floor(high_[i] * frame_.perVoxel + kOnVoxels);
  }
  return true;
}

void ProjectionMarch::marchTogether(Values& values) {
  const float background = frame_.voxels->volume().background;
  const float infinity = std::numeric_limits<float>::infinity();
  const float start = frame_.kind == ProjectionKind::largest    ? -infinity
                      : frame_.kind == ProjectionKind::smallest ? infinity
                                                                : 0;
  // Rays that meet nothing never ask for a brick.
  for (std::size_t i = 0; i < kRayGroup; ++i) values[i] = valid_[i] ? start : -start;
  hasPath_ = false;
  met_.clear();
  if (std::ranges::find(valid_, true) != valid_.end()) {
    findBounds();
    listBricks();
    for (const Met& met : met_) {
      if (frame_.skipping && !beats(met.bound, met.bound, threshold(values))) break;
      take(met, values);
    }
    addEnds(values);
  }
  for (std::size_t i = 0; i < kRayGroup; ++i)
    if (!valid_[i]) values[i] = background;
}

void ProjectionMarch::findBounds() {
  least_ = std::numeric_limits<double>::infinity();
  most_ = -least_;
  for (std::size_t i = 0; i < kRayGroup; ++i)
    if (valid_[i]) {
      least_ = std::min(least_, low_[i]);
      most_ = std::max(most_, high_[i]);
    }
  for (std::size_t end = 0; end < 2; ++end) {
    const double n = end == 0 ? least_ : most_;
    for (std::size_t across = 0; across < 2; ++across) {
      double& lowest = lowest_[across][end] = std::numeric_limits<double>::infinity();
      double& highest = highest_[across][end] = -lowest;
      for (std::size_t i = 0; i < kRayGroup; ++i)
        if (valid_[i]) {
          const double at = across == 0 ? u0_[i] + slopeU_[i] * n : v0_[i] + slopeV_[i] * n;
          lowest = std::min(lowest, at);
          highest = std::max(highest, at);
        }
    }
  }
}

namespace {

// The extent of a packet across, between two places along n. The least of straight lines lies above the straight line
// through its ends, so that the two lines bound the rays.
struct Across {
  double low, high;
};
Across acrossOf(const std::array<double, 2>& lowest, const std::array<double, 2>& highest, double a, double b) {
  const auto at = [](const std::array<double, 2>& ends, double share) { return ends[0] + share * (ends[1] - ends[0]); };
  // A float's rounding may bring a ray into the cell beside its own.
  constexpr double kRounding = 1e-3;
  return {std::min(at(lowest, a), at(lowest, b)) - kRounding, std::max(at(highest, a), at(highest, b)) + kRounding};
}

}  // namespace

void ProjectionMarch::listBricks() {
  const BrickTable& table = *frame_.table;
  const float background = frame_.voxels->volume().background;
  const auto cells = [&](double low, double high, int axis) {
    const double first = std::max<double>(low, frame_.box.min[axis]),
                 last = std::min<double>(high, frame_.box.max[axis]);
    return std::pair(table.cellOf(cellBelow(first), axis), table.cellOf(cellBelow(last), axis));
  };
  const double way = most_ - least_;
  const auto [firstLayer, lastLayer] = cells(least_, most_, n_);
  for (std::int64_t layer = firstLayer; layer <= lastLayer; ++layer) {
    const auto begin = static_cast<double>(table.firstOf(layer, n_)),
               end = static_cast<double>(table.firstOf(layer + 1, n_));
    const double a = way > 0 ? std::clamp((begin - least_) / way, 0.0, 1.0) : 0;
    const double b = way > 0 ? std::clamp((end - least_) / way, 0.0, 1.0) : 0;
    const Across u = acrossOf(lowest_[0], highest_[0], a, b), v = acrossOf(lowest_[1], highest_[1], a, b);
    const auto [u0, u1] = cells(u.low, u.high, u_);
    const auto [v0, v1] = cells(v.low, v.high, v_);
    Met met;
    met.layer = layer;
    met.cell[static_cast<std::size_t>(n_)] = layer;
    for (std::int64_t j = v0; j <= v1; ++j)
      for (std::int64_t i = u0; i <= u1; ++i) {
        met.cell[static_cast<std::size_t>(u_)] = i;
        met.cell[static_cast<std::size_t>(v_)] = j;
        met.entry = table.find(met.cell);
        const Range range = !met.entry         ? Range{background, background}
                            : met.entry->brick ? met.entry->brick->value
                                               : Range{met.entry->value, met.entry->value};
        if (frame_.kind == ProjectionKind::sum && range.min == background && range.max == background) continue;
        met.bound = frame_.kind == ProjectionKind::smallest ? range.min : range.max;
        met_.push_back(met);
      }
  }
  if (frame_.kind == ProjectionKind::largest)
    std::ranges::sort(met_, [](const Met& a, const Met& b) { return a.bound > b.bound; });
  else if (frame_.kind == ProjectionKind::smallest)
    std::ranges::sort(met_, [](const Met& a, const Met& b) { return a.bound < b.bound; });
}

// Returns what a range of values must exceed, or fall below, to change a ray.
float ProjectionMarch::threshold(const Values& values) const {
  if (frame_.kind == ProjectionKind::largest) return *std::ranges::min_element(values);
  if (frame_.kind == ProjectionKind::smallest) return *std::ranges::max_element(values);
  return 0;
}

bool ProjectionMarch::beats(float low, float high, float threshold) const {
  if (frame_.kind == ProjectionKind::largest) return high > threshold;
  if (frame_.kind == ProjectionKind::smallest) return low < threshold;
  return true;
}

const ProjectionPath& ProjectionMarch::pathOf(std::int64_t layer) {
  if (hasPath_ && pathLayer_ == layer) return path_;
  hasPath_ = true;
  pathLayer_ = layer;
  const auto first = static_cast<double>(frame_.table->firstOf(layer, n_));
  const auto end = static_cast<double>(frame_.table->firstOf(layer + 1, n_));
  bool based = false;
  for (std::size_t i = 0; i < kRayGroup; ++i) {
    if (!valid_[i]) {
      path_.u[i] = path_.v[i] = path_.slopeU[i] = path_.slopeV[i] = path_.low[i] = path_.high[i] = 0;
      path_.first[i] = 0;  // no slice lies between these
      path_.last[i] = -1;
      continue;
    }
    const double u = u0_[i] + slopeU_[i] * first, v = v0_[i] + slopeV_[i] * first;
    if (!based) {
      baseU_ = cellBelow(u);
      baseV_ = cellBelow(v);
      based = true;
    }
    path_.u[i] = static_cast<float>(u - static_cast<double>(baseU_));
    path_.v[i] = static_cast<float>(v - static_cast<double>(baseV_));
    path_.slopeU[i] = static_cast<float>(slopeU_[i]);
    path_.slopeV[i] = static_cast<float>(slopeV_[i]);
    path_.low[i] = static_cast<float>(std::clamp(low_[i] - first, -4.0, end - first + 4));
    path_.high[i] = static_cast<float>(std::clamp(high_[i] - first, -4.0, end - first + 4));
    const double slices = (end - first) * frame_.perVoxel;
    path_.first[i] = static_cast<float>(std::clamp(first_[i] - first * frame_.perVoxel, 0.0, slices));
    path_.last[i] = static_cast<float>(std::clamp(last_[i] - first * frame_.perVoxel, -1.0, slices));
  }
  return path_;
}

// Takes those groups of a brick's cells that may change a ray, in runs of layers of groups.
void ProjectionMarch::take(const Met& met, Values& values) {
  const BrickTable& table = *frame_.table;
  const BrickVoxels& voxels = *frame_.voxels;
  const BrickLayout& layout = voxels.volume().layout;
  const glm::ivec3 edge = layout.edge();
  const std::ptrdiff_t strides[3]{1, edge.x, static_cast<std::ptrdiff_t>(edge.x) * edge.y};
  const ProjectionPath& path = pathOf(met.layer);
  const VoxelBrick* const held = met.entry ? met.entry->brick : nullptr;
  ProjectionBrick brick;
  brick.code = voxels.code();
  brick.offset = static_cast<float>(voxels.offset());
  brick.background = voxels.volume().background;
  brick.value = held ? held->value.min : met.entry ? met.entry->value : brick.background;
  brick.voxels = held ? held->voxels.get() : nullptr;
  brick.firstU = static_cast<std::int32_t>(table.firstOf(met.cell[static_cast<std::size_t>(u_)], u_) - baseU_);
  brick.firstV = static_cast<std::int32_t>(table.firstOf(met.cell[static_cast<std::size_t>(v_)], v_) - baseV_);
  brick.endU = brick.firstU + layout.interior[u_];
  brick.endV = brick.firstV + layout.interior[v_];
  brick.strideU = strides[u_];
  brick.strideV = strides[v_];
  brick.strideN = strides[n_];
  brick.first = layout.apron * (strides[0] + strides[1] + strides[2]);
  const int per = frame_.perVoxel;
  const auto first = static_cast<double>(table.firstOf(met.layer, n_));
  const auto sliceOf = [&](double n, double towards) {
    const double at = (n - first) * per;
    return static_cast<int>(std::clamp(towards > 0 ? std::ceil(at - 1e-6) : std::floor(at + 1e-6), -1.0,
                                       static_cast<double>(layout.interior[n_]) * per));
  };
  const int begin = std::max(sliceOf(least_, 1), 0);
  const int end = std::min(sliceOf(most_, -1) + 1, layout.interior[n_] * per);
  if (!held || !held->ranges) {
    projectBrick(frame_.kind, path, brick, per, begin, end, values.data());
    samples_ += static_cast<std::uint64_t>(std::max(end - begin, 0)) * kRayGroup;
    return;
  }
  constexpr int kGroup = BrickVoxels::kGroup;
  int run = begin;
  for (int group = begin / (kGroup * per); group * kGroup * per < end; ++group) {
    const int from = std::max(group * kGroup * per, begin), to = std::min((group + 1) * kGroup * per, end);
    if (frame_.skipping && !isMet(*met.entry, group, first + static_cast<double>(from) / per,
                                  first + static_cast<double>(to) / per, threshold(values))) {
      run = to;
      continue;
    }
    projectBrick(frame_.kind, path, brick, per, run, to, values.data());
    samples_ += static_cast<std::uint64_t>(to - run) * kRayGroup;
    run = to;
  }
}

// Tells whether a layer of groups may change a ray.
bool ProjectionMarch::isMet(const PlacedBrick& entry, std::int64_t groupN, double from, double to,
                            float threshold) const {
  constexpr int kGroup = BrickVoxels::kGroup;
  const glm::ivec3 groups = frame_.voxels->groups(), interior = frame_.voxels->volume().layout.interior;
  const std::ptrdiff_t strides[3]{1, groups.x, static_cast<std::ptrdiff_t>(groups.x) * groups.y};
  const float background = frame_.voxels->volume().background;
  const double way = most_ - least_;
  const double a = way > 0 ? (from - least_) / way : 0, b = way > 0 ? (to - least_) / way : 0;
  const Across u = acrossOf(lowest_[0], highest_[0], a, b), v = acrossOf(lowest_[1], highest_[1], a, b);
  const auto groupOf = [&](double place, int axis) {
    const double offset = std::floor(place) - static_cast<double>(entry.origin[axis]);
    return static_cast<std::int64_t>(std::clamp(offset, 0.0, interior[axis] - 1.0)) / kGroup;
  };
  const float* const ranges = entry.brick->ranges.get();
  const std::int64_t u0 = groupOf(u.low, u_), u1 = groupOf(u.high, u_), v0 = groupOf(v.low, v_),
                     v1 = groupOf(v.high, v_);
  for (std::int64_t y = v0; y <= v1; ++y)
    for (std::int64_t x = u0; x <= u1; ++x) {
      const float* const range = ranges + 2 * (groupN * strides[n_] + y * strides[v_] + x * strides[u_]);
      if (frame_.kind == ProjectionKind::sum ? range[0] != background || range[1] != background
                                             : beats(range[0], range[1], threshold))
        return true;
    }
  return false;
}

// Adds the field at both ends of each ray's way and, of means, divides by its length.
void ProjectionMarch::addEnds(Values& values) {
  const Box box{glm::dvec3(frame_.box.min), glm::dvec3(frame_.box.max)};
  const float background = frame_.voxels->volume().background;
  const double per = frame_.perVoxel;
  for (std::size_t i = 0; i < kRayGroup; ++i) {
    if (!valid_[i]) continue;
    const auto pointAt = [&](double n) {
      glm::dvec3 point;
      point[n_] = n;
      point[u_] = u0_[i] + slopeU_[i] * n;
      point[v_] = v0_[i] + slopeV_[i] * n;
      return glm::clamp(point, box.min, box.max);
    };
    if (frame_.kind != ProjectionKind::sum) {
      for (const double n : {low_[i], high_[i]}) {
        const VoxelPoint point(*frame_.voxels, *frame_.table, pointAt(n));
        if (!beats(point.range().min, point.range().max, values[i])) continue;
        const auto value = static_cast<float>(point.value());
        values[i] = frame_.kind == ProjectionKind::largest ? std::max(values[i], value) : std::min(values[i], value);
      }
      continue;
    }
    const double length = high_[i] - low_[i];
    const auto above = [&](double n) {
      return VoxelPoint(*frame_.voxels, *frame_.table, pointAt(n)).value() - background;
    };
    if (length < kOnVoxels) {
      values[i] = static_cast<float>(background + above(low_[i]));
      continue;
    }
    const double first = first_[i] / per, last = last_[i] / per;
    const double atLow = first <= last ? first - low_[i] : length, atHigh = first <= last ? high_[i] - last : length;
    double sum = static_cast<double>(values[i]);
    // Ends that lie on slices have been counted there.
    if (atLow > kOnVoxels) sum += 0.5 * atLow * above(low_[i]);
    if (atHigh > kOnVoxels) sum += 0.5 * atHigh * above(high_[i]);
    values[i] = static_cast<float>(background + sum / length);
  }
}

}  // namespace umbrick
