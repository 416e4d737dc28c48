// SPDX-License-Identifier: Apache-2.0
#include "sweep/row_march.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "sweep/ray_clip.h"

namespace umbrick {
namespace {

// Rays may lie so far beyond the bricks that their places are no numbers of voxels any more.
std::int64_t bounded(double at, std::int64_t low, std::int64_t high) {
  return static_cast<std::int64_t>(std::clamp(at, static_cast<double>(low), static_cast<double>(high)));
}

}  // namespace

RowMarch::RowMarch(const MarchFrame& frame)
    : frame_(frame),
      reader_(*frame.voxels, *frame.rows, *frame.lattice, *frame.table, frame.lights, frame.lightUnit,
              frame.classified),
      groups_((frame.lattice->width + kRayGroup - 1) / kRayGroup) {
  const auto rays = static_cast<std::size_t>(groups_) * kRayGroup, groups = static_cast<std::size_t>(groups_);
  for (Row* row : {&red_, &green_, &blue_, &opacity_, &length_}) row->resize(rays);
  if (frame.aux)
    for (Row* row : {&seen_, &depth_}) row->resize(rays);
  if (!frame.planes.empty()) {
    for (Row* row : {&enter_, &leave_}) row->resize(rays);
    for (Row* row : {&firstEnter_, &lastEnter_, &firstLeave_, &lastLeave_}) row->resize(groups);
  }
  for (auto& side : fields_)
    for (int field = 0; field < kMostFields; ++field)
      if (reader_.has(field)) side[static_cast<std::size_t>(field)].resize(rays);
  for (auto& side : sampled_) side.resize(groups);
  full_.resize(groups);
  active_.resize(groups);
}

std::uint64_t RowMarch::march(int j, LatticePicture& picture) {
  beginRow(j);
  samples_ = 0;
  bool any = false;
  for (std::size_t slice = 0; slice + 1 < frame_.slices.size(); ++slice) {
    if (!findActive(slice)) continue;
    any = true;
    for (int group = 0; group < groups_;) {
      if (!active_[static_cast<std::size_t>(group)]) {
        ++group;
        continue;
      }
      int end = group + 1;
      while (end < groups_ && active_[static_cast<std::size_t>(end)]) ++end;
      sample(group, end, slice);
      sample(group, end, slice + 1);
      integrate(group, end, slice);
      group = end;
    }
  }
  const auto first = static_cast<std::size_t>(j) * static_cast<std::size_t>(picture.stride);
  const auto width = static_cast<std::size_t>(frame_.lattice->width);
  if (!any) return 0;  // pictures begin empty
  picture.filled[static_cast<std::size_t>(j)] = 1;
  for (std::size_t i = 0; i < width; ++i) picture.colour[first + i] = {red_[i], green_[i], blue_[i], opacity_[i]};
  if (frame_.aux) storeAux(j, picture.aux.data() + first);
  return samples_;
}

// Turns the mean way along the main axis into a depth, which is linear along a ray.
void RowMarch::storeAux(int j, glm::vec2* aux) const {
  const RayLattice& lattice = *frame_.lattice;
  const double front = frame_.slices.front().at;
  const auto depthAt = [&](double column, double n) {
    const glm::dvec2 across = lattice.start(n) + lattice.spacing(n) * glm::dvec2(column, j);
    return glm::dot(lattice.depth, glm::dvec4(across, n, 1));
  };
  for (int i = 0; i < lattice.width; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double first = depthAt(i, front), perVoxel = depthAt(i, front + lattice.sign) - first;
    aux[i] = {seen_[at], static_cast<float>(opacity_[at] * first + depth_[at] * perVoxel)};
  }
}

void RowMarch::beginRow(int j) {
  j_ = j;
  for (Row* row : {&red_, &green_, &blue_, &opacity_, &seen_, &depth_}) std::ranges::fill(*row, 0.0f);
  for (auto& side : sampled_) std::ranges::fill(side, -1);
  std::ranges::fill(full_, 0);
  const RayLattice& lattice = *frame_.lattice;
  // The length squared is a quadratic function of the slope along u.
  const glm::dmat3& m = lattice.metric;
  const glm::dvec2 first = lattice.slopeOf(0, j);
  const double across = lattice.perspective ? lattice.step.x : 0;
  const double constant = m[1][1] * first.y * first.y + 2 * m[1][2] * first.y + m[2][2];
  const double linear = 2 * (m[0][1] * first.y + m[0][2]);
  for (std::size_t i = 0; i < length_.size(); ++i) {
    const double slope = first.x + across * static_cast<double>(i);
    length_[i] = static_cast<float>(std::sqrt(std::max(constant + slope * (linear + slope * m[0][0]), 0.0)));
  }
  if (!frame_.planes.empty()) clipRays(j);
}

// Finds the part of each ray that all planes leave, as the way from the first slice.
void RowMarch::clipRays(int j) {
  const RayLattice& lattice = *frame_.lattice;
  const double front = frame_.slices.front().at, way = std::abs(frame_.slices.back().at - front) + 1;
  const glm::dvec2 start = frame_.slices.front().start, spacing = frame_.slices.front().spacing;
  for (std::size_t i = 0; i < length_.size(); ++i) {
    const double column = static_cast<double>(i);
    const glm::dvec2 slope = lattice.slopeOf(column, j), at = start + spacing * glm::dvec2(column, j);
    const KeptWay kept = keptWay(frame_.planes, at, front, slope, lattice.sign, way);
    enter_[i] = kept.enter;
    leave_[i] = kept.leave;
  }
  for (int group = 0; group < groups_; ++group) {
    const auto begin = group * kRayGroup, end = begin + kRayGroup;
    const auto g = static_cast<std::size_t>(group);
    const auto [a, b] = std::minmax_element(enter_.begin() + begin, enter_.begin() + end);
    const auto [c, d] = std::minmax_element(leave_.begin() + begin, leave_.begin() + end);
    firstEnter_[g] = *a;
    lastEnter_[g] = *b;
    firstLeave_[g] = *c;
    lastLeave_[g] = *d;
  }
}

// Marks the groups of rays that meet something visible between two slices and are not full.
bool RowMarch::findActive(std::size_t slice) {
  const double near = frame_.slices[slice].at, far = frame_.slices[slice + 1].at;
  const auto layer = static_cast<std::int64_t>(std::floor(0.5 * (near + far)));
  const double v0 = rowAt(slice), v1 = rowAt(slice + 1);
  const glm::ivec3 low = frame_.rows->low(), high = frame_.rows->high();
  if (std::max(v0, v1) < low.y - 1 || std::min(v0, v1) > high.y) return false;
  const std::int64_t firstRow = bounded(std::floor(std::min(v0, v1)), low.y - 1, high.y);
  const std::int64_t lastRow = bounded(std::floor(std::max(v0, v1)), low.y - 1, high.y);
  bool some = false;
  for (std::int64_t row = firstRow; row <= lastRow; ++row)
    for (const BrickRows::Cells& cells : frame_.rows->activeCells(row, layer)) {
      if (!some) std::ranges::fill(active_, 0);
      some = true;
      mark(cells, slice);
    }
  if (!some) return false;
  bool any = false;
  for (std::size_t group = 0; group < active_.size(); ++group) {
    active_[group] = active_[group] && !full_[group];
    if (active_[group] && !frame_.planes.empty()) {
      const double from = std::abs(near - frame_.slices.front().at), to = std::abs(far - frame_.slices.front().at);
      active_[group] = lastLeave_[group] > from && firstEnter_[group] < to;
    }
    any = any || active_[group];
  }
  return any;
}

// Marks the rays that may cross cells between a slice and the next.
void RowMarch::mark(const BrickRows::Cells& cells, std::size_t slice) {
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const std::size_t side : {slice, slice + 1}) {
    const double spacing = frame_.slices[side].spacing.x, start = frame_.slices[side].start.x;
    if (spacing < 1e-6) {  // at the eye all rays are in one place
      first = 0;
      last = frame_.lattice->width;
      break;
    }
    const double per = 1 / spacing;
    first = std::min(first, (cells.begin - start) * per);
    last = std::max(last, (cells.end - start) * per);
  }
  const int width = frame_.lattice->width;
  if (last < 0 || first > width - 1) return;
  const auto a = static_cast<std::ptrdiff_t>(std::max(first, 0.0)) / kRayGroup;
  const auto b = static_cast<std::ptrdiff_t>(std::min(last + 1, width - 1.0)) / kRayGroup;
  std::fill(active_.begin() + a, active_.begin() + b + 1, 1);
}

// Interpolates the fields of groups on a slice, those that are not known yet.
void RowMarch::sample(int group, int end, std::size_t slice) {
  std::vector<std::int64_t>& sampled = sampled_[slice % 2];
  const auto isKnown = [&](int g) { return sampled[static_cast<std::size_t>(g)] == static_cast<std::int64_t>(slice); };
  while (group < end && isKnown(group)) ++group;
  while (end > group && isKnown(end - 1)) --end;
  if (group == end) return;
  RowPlaces places;
  places.spacing = frame_.slices[slice].spacing.x;
  places.x0 = frame_.slices[slice].start.x;
  const glm::ivec3 low = frame_.rows->low(), high = frame_.rows->high();
  const int first = group * kRayGroup, count = (end - group) * kRayGroup;
  const std::int64_t begin = bounded(std::floor(places.x0 + first * places.spacing), low.x - 4, high.x + 2);
  const std::int64_t behind =
      bounded(std::floor(places.x0 + (first + count - 1) * places.spacing) + 2, low.x - 2, high.x + 4);
  places.begin = begin;
  const std::int64_t last = std::max(behind, begin + 2);
  reader_.read(rowAt(slice), frame_.slices[slice].at, begin, last);
  std::array<const float*, kMostFields> from{};
  std::array<float*, kMostFields> to{};
  int fields = 0;
  for (int field = 0; field < kMostFields; ++field)
    if (reader_.has(field)) {
      from[static_cast<std::size_t>(fields)] = reader_.row(field);
      to[static_cast<std::size_t>(fields++)] = fields_[slice % 2][static_cast<std::size_t>(field)].data();
    }
  sampleRows(places, first, count, static_cast<int>(last - begin), fields, from.data(), to.data());
  std::fill(sampled.begin() + group, sampled.begin() + end, static_cast<std::int64_t>(slice));
}

void RowMarch::integrate(int group, int end, std::size_t slice) {
  RowSegment segment = frame_.segment(frame_.slices.front().at, frame_.slices[slice].at, frame_.slices[slice + 1].at);
  if (!frame_.planes.empty())
    for (int g = group; g < end; ++g) {
      const auto at = static_cast<std::size_t>(g);
      segment.clipped = segment.clipped || lastEnter_[at] > segment.from || firstLeave_[at] < segment.to;
    }
  const RowRays rays{red_.data(),
                     green_.data(),
                     blue_.data(),
                     opacity_.data(),
                     frame_.aux ? seen_.data() : nullptr,
                     frame_.aux ? depth_.data() : nullptr,
                     length_.data(),
                     enter_.data(),
                     leave_.data(),
                     full_.data()};
  std::array<const float*, kMostFields> front{}, back{};
  for (std::size_t field = 0; field < kMostFields; ++field) {
    front[field] = fields_[slice % 2][field].data();
    back[field] = fields_[(slice + 1) % 2][field].data();
  }
  integrateRows(*frame_.table, segment, rays, group * kRayGroup, (end - group) * kRayGroup, front.data(), back.data());
  samples_ += static_cast<std::uint64_t>(end - group) * kRayGroup;
}

}  // namespace umbrick
