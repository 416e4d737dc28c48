// SPDX-License-Identifier: Apache-2.0
#include "light/cell_store.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace umbrick {

void LitBlocks::markRow(const char* medium, int y, int z, int around) {
  // The voxels next to the medium, and places of light around them.
  const int reach = light_.spacing + around;
  std::fill(row_.begin(), row_.end(), char{0});
  bool any = false;
  for (int x = -apron_; x + 1 < interior_.x + apron_; ++x)
    if (medium[x + apron_]) {
      row_[static_cast<std::size_t>(blockOf(x - reach, count_.x))] = 1;
      row_[static_cast<std::size_t>(blockOf(x, count_.x))] = 1;
      row_[static_cast<std::size_t>(blockOf(x + 1 + reach, count_.x))] = 1;
      any = true;
    }
  if (!any) return;
  for (int n = blockOf(z - reach, count_.z); n <= blockOf(z + 1 + reach, count_.z); ++n)
    for (int v = blockOf(y - reach, count_.y); v <= blockOf(y + 1 + reach, count_.y); ++v)
      for (int u = 0; u < count_.x; ++u)
        lit_[static_cast<std::size_t>(n * stride(2) + v * stride(1) + u)] |= row_[static_cast<std::size_t>(u)];
}

PlaneWindow LitBlocks::around(const SweepAxes& axes, int first, int last, int margin) const {
  PlaneWindow box{count_[axes.u], 0, count_[axes.v], 0};  // in blocks
  for (int n = blockOf(first, count_[axes.n]); n <= blockOf(last, count_[axes.n]); ++n)
    for (int v = 0; v < count_[axes.v]; ++v)
      for (int u = 0; u < count_[axes.u]; ++u)
        if (lit_[static_cast<std::size_t>(n * stride(axes.n) + v * stride(axes.v) + u * stride(axes.u))])
          box.include({u, u + 1, v, v + 1});
  if (box.empty()) return {};
  // The apron belongs to the outer blocks.
  const int outside = light_.apron * light_.spacing;
  const auto low = [&](int block) { return (block == 0 ? -outside : block * kEdge) - margin; };
  const auto high = [&](int block, int axis) {
    return (block == count_[axis] ? interior_[axis] + outside : block * kEdge) + margin;
  };
  return {low(box.u0), high(box.u1, axes.u), low(box.v0), high(box.v1, axes.v)};
}

void RowSpans::join(int gap) {
  for (std::vector<Span>& row : rows_) {
    std::sort(row.begin(), row.end(), [](const Span& a, const Span& b) { return a.begin < b.begin; });
    std::size_t kept = 0;
    for (const Span& span : row)
      if (kept > 0 && span.begin <= row[kept - 1].end + gap)
        row[kept - 1].end = std::max(row[kept - 1].end, span.end);
      else
        row[kept++] = span;
    row.resize(kept);
  }
}

std::size_t RowSpans::length() const {
  std::size_t sum = 0;
  for (const std::vector<Span>& row : rows_)
    for (const Span& span : row) sum += static_cast<std::size_t>(span.end - span.begin);
  return sum;
}

SweepLattice::SweepLattice(int axis, const std::vector<glm::ivec3>& origins, const BrickLayout& layout,
                           const LightLayout& light)
    : axes_(kSweepAxes[axis]), apron_(layout.apron), light_(light) {
  const auto swept = [&](const glm::ivec3& p) { return glm::ivec3(p[axes_.u], p[axes_.v], p[axes_.n]); };
  interior_ = swept(layout.interior);
  order_.resize(origins.size());
  std::iota(order_.begin(), order_.end(), 0);
  const auto key = [&](int i) {
    const glm::ivec3 p = swept(origins[static_cast<std::size_t>(i)]);
    return std::tuple(p.z, p.y, p.x);
  };
  std::sort(order_.begin(), order_.end(), [&](int a, int b) { return key(a) < key(b); });
  for (const int i : order_) {
    const glm::ivec3 p = swept(origins[static_cast<std::size_t>(i)]), last = p + interior_ - 1;
    if (place_.empty()) {
      low_ = p;
      high_ = last;
    }
    for (int c = 0; c < 3; ++c) {
      low_[c] = std::min(low_[c], p[c]);
      high_[c] = std::max(high_[c], last[c]);
    }
    if (layers_.empty() || layers_.back().n != p.z) layers_.push_back({p.z, place_.size(), place_.size()});
    place_.push_back(p);
    layers_.back().end = place_.size();
  }
}

int SweepLattice::kindOf(int n) const {
  int kind = 0;
  for (const Layer& layer : layers_) {
    if (n < layer.n - reach()) continue;
    // The numbers of the blocks' layers; the apron belongs to the outer ones.
    const int last = (interior_[2] - 1) / LitBlocks::kEdge;
    kind +=
        n >= layer.n + interior_[2] + reach() ? last + 2 : 1 + std::clamp((n - layer.n) / LitBlocks::kEdge, 0, last);
  }
  return kind;
}

}  // namespace umbrick
