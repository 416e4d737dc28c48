// SPDX-License-Identifier: Apache-2.0
#include "light/slice_planes.h"

#include <algorithm>

#include "light/sweep_kernels.h"

namespace umbrick {
namespace {

// By so many voxels the values of a brick are continued beyond its apron: as far as paths around its outermost place of
// light may lie, on the slice of the place or on the one before.
int continuation(const SweepLattice& lattice) { return lattice.spacing() == 1 ? 2 : 5; }

// Values are read no farther from places of light than this: around paths next to them, on the slice before, too, and
// where rows were joined over a few places without light.
constexpr int kAround = LitBlocks::kEdge / 2 + 5;

// Paths move by at most one voxel from slice to slice.
constexpr int kDrift = kSlicesTogether + 4;

std::array<std::ptrdiff_t, 3> strides(const SweepAxes& axes, const glm::ivec3& edge) {
  const std::ptrdiff_t plain[3]{1, edge.x, std::ptrdiff_t(edge.x) * edge.y};
  return {plain[axes.u], plain[axes.v], plain[axes.n]};
}

}  // namespace

ValuePlanes::ValuePlanes(const SweptBricks& bricks, const SweepLattice& lattice)
    : bricks_(bricks),
      lattice_(lattice),
      together_(slicesTogether(lattice.axes())),
      first_(lattice.firstSlice() - kSlicesTogether),
      held_{-1, -1} {
  const int s = lattice.spacing();
  for (int i = 0; i < 2 * together_; ++i) planes_.emplace_back(lattice.width() * s, lattice.height() * s, kRowPadding);
}

void ValuePlanes::require(int n, const PlaneWindow& window) {
  const int group = (n - first_) / together_;
  int& held = held_[static_cast<std::size_t>(group % 2)];
  if (held == group) return;
  held = group;
  const int first = first_ + group * together_, last = first + together_ - 1;
  const int apron = lattice_.apron(), s = lattice_.spacing(), beyond = continuation(lattice_);
  const int slices = lattice_.reach() + 1 - apron;
  const glm::ivec3 interior = lattice_.interior();
  const auto needed = [&](const glm::ivec3& place) {
    const int u = place.x - lattice_.columnOrigin(), v = place.y - lattice_.rowOrigin();
    const int around = apron + beyond + kDrift;
    return u - around < window.u1 * s && u + interior.x + around > window.u0 * s && v - around < window.v1 * s &&
           v + interior.y + around > window.v0 * s;
  };
  // Beyond the apron of a brick, where there is no medium, values are the same as on the brick's side, so that no path
  // meets a value that nothing has.
  lattice_.forEachBrick(first, last, apron + slices, [&](int brick, const glm::ivec3& place) {
    if (needed(place)) put(brick, place, first, last, beyond, slices);
  });
  lattice_.forEachBrick(first, last, apron, [&](int brick, const glm::ivec3& place) {
    if (needed(place)) put(brick, place, first, last, 0, 0);
  });
}

void ValuePlanes::put(int brick, const glm::ivec3& place, int first, int last, int beyond, int beyondSlices) {
  const int apron = lattice_.apron();
  const glm::ivec3 edge = lattice_.interior() + 2 * apron;  // along u, v, n
  const int base = place.z - apron;                         // the slice of the first layer
  first = std::max(first, base - beyondSlices);
  last = std::min(last, base + edge.z - 1 + beyondSlices);
  // Counted from the apron's first voxel.
  PlaneWindow part = bricks_.lit[static_cast<std::size_t>(brick)].around(lattice_.axes(), first - place.z - kAround,
                                                                         last - place.z + kAround, kAround);
  part = {std::max(part.u0 + apron, -beyond), std::min(part.u1 + apron, edge.x + beyond),
          std::max(part.v0 + apron, -beyond), std::min(part.v1 + apron, edge.y + beyond)};
  if (part.empty()) return;
  const auto stride = strides(lattice_.axes(), bricks_.layout.edge());
  const float* from = bricks_.values->data() + static_cast<std::size_t>(brick) * bricks_.layout.voxels();
  const int count = last - first + 1, begin = std::max(part.u0, 0), end = std::min(part.u1, edge.x);
  std::array<float*, kSlicesTogether> to{};  // to the apron's first voxel
  std::array<std::ptrdiff_t, kSlicesTogether> layer{};
  for (int k = 0; k < count; ++k)
    layer[static_cast<std::size_t>(k)] = std::clamp(first + k - base, 0, edge.z - 1) * stride[2];
  for (int v = part.v0; v < part.v1; ++v) {
    const float* row = from + std::clamp(v, 0, edge.y - 1) * stride[1];
    for (int k = 0; k < count; ++k)
      to[static_cast<std::size_t>(k)] =
          plane(first + k).row(place.y - apron + v - lattice_.rowOrigin(), place.x - apron - lattice_.columnOrigin());
    if (stride[0] == 1) {
      for (int k = 0; k < count; ++k)
        std::copy(row + layer[static_cast<std::size_t>(k)] + begin, row + layer[static_cast<std::size_t>(k)] + end,
                  to[static_cast<std::size_t>(k)] + begin);
    } else {
      for (int u = begin; u < end; ++u)
        for (int k = 0; k < count; ++k)
          to[static_cast<std::size_t>(k)][u] = row[u * stride[0] + layer[static_cast<std::size_t>(k)]];
    }
    for (int k = 0; k < count; ++k) {
      float* const all = to[static_cast<std::size_t>(k)];
      for (int u = part.u0; u < 0; ++u) all[u] = row[layer[static_cast<std::size_t>(k)]];
      for (int u = edge.x; u < part.u1; ++u)
        all[u] = row[(edge.x - 1) * stride[0] + layer[static_cast<std::size_t>(k)]];
    }
  }
}

LightPlanes::LightPlanes(SweptBricks& bricks, const SweepLattice& lattice)
    : bricks_(bricks),
      lattice_(lattice),
      together_(slicesTogether(lattice.axes())),
      first_(lattice.firstSlice() - kSlicesTogether) {
  for (int i = 0; i < together_ * bricks.channels; ++i)
    planes_.emplace_back(lattice.width(), lattice.height(), kRowPadding);
}

void LightPlanes::begin(int n) {
  if (!lit_.empty() && groupOf(n) != groupOf(lit_.front())) finish();
}

void LightPlanes::end(int n, const PlaneWindow& window) {
  if (window.empty()) return;
  if (lit_.empty()) window_ = window;
  window_.include(window);
  lit_.push_back(n);
}

void LightPlanes::finish() {
  if (lit_.empty()) return;
  std::ranges::sort(lit_);
  const int apron = lattice_.lightApron();
  const glm::ivec3 interior = lattice_.lightInterior();
  const auto inWindow = [&](const glm::ivec3& place) {
    const int u = (place.x - lattice_.columnOrigin()) / lattice_.spacing() - apron;
    const int v = (place.y - lattice_.rowOrigin()) / lattice_.spacing() - apron;
    return u < window_.u1 && u + interior.x + 2 * apron > window_.u0 && v < window_.v1 &&
           v + interior.y + 2 * apron > window_.v0;
  };
  lattice_.forEachBrick(lit_.front(), lit_.back(), lattice_.reach(), [&](int brick, const glm::ivec3& place) {
    if (inWindow(place)) addTo(brick, place);
  });
  // Rows that were joined over places without light hold some there, too.
  lattice_.forEachBrick(lit_.front(), lit_.back(), lattice_.reach(), [&](int, const glm::ivec3& place) {
    if (!inWindow(place)) return;
    const int u = (place.x - lattice_.columnOrigin()) / lattice_.spacing() - apron;
    const int v = (place.y - lattice_.rowOrigin()) / lattice_.spacing() - apron;
    for (const int n : lit_)
      for (int c = 0; c < bricks_.channels; ++c)
        for (int row = 0; row < interior.y + 2 * apron; ++row)
          std::fill_n(plane(n, c).row(v + row, u), interior.x + 2 * apron, 0);
  });
  lit_.clear();
}

void LightPlanes::addTo(int brick, const glm::ivec3& place) {
  const int apron = lattice_.lightApron(), s = lattice_.spacing();
  const glm::ivec3 interior = lattice_.lightInterior();
  const auto stride = strides(lattice_.axes(), bricks_.light.edge());
  const int column = (place.x - lattice_.columnOrigin()) / s, rows = (place.y - lattice_.rowOrigin()) / s;
  std::array<const std::int32_t*, kSlicesTogether> from{};
  std::array<std::ptrdiff_t, kSlicesTogether> layer{};
  std::array<int, kSlicesTogether> slice{};
  std::size_t count = 0;
  for (const int n : lit_) {
    const int at = (n - place.z) / s + apron;
    if (n < place.z - apron * s || at >= interior.z + 2 * apron) continue;
    slice[count] = n;
    layer[count++] = at * stride[2];
  }
  if (count == 0) return;
  const LitBlocks& lit = bricks_.lit[static_cast<std::size_t>(brick)];
  const std::scoped_lock lock(bricks_.busy[static_cast<std::size_t>(brick)]);
  for (int c = 0; c < bricks_.channels; ++c) {
    std::int32_t* const sums =
        bricks_.sums.data() +
        (static_cast<std::size_t>(brick) * static_cast<std::size_t>(bricks_.channels) + static_cast<std::size_t>(c)) *
            bricks_.light.places();
    for (int v = -apron; v < interior.y + apron; ++v) {
      std::int32_t* const to = sums + (v + apron) * stride[1] + apron * stride[0];
      for (std::size_t k = 0; k < count; ++k) from[k] = plane(slice[k], c).row(rows + v, column);
      // Slices of one layer of blocks have light at the same places.
      for (std::size_t k = 0; k < count;) {
        const auto block = [&](std::size_t i) { return lit.layerOf(lattice_.axes(), slice[i] - place.z); };
        std::size_t end = k + 1;
        while (end < count && block(end) == block(k)) ++end;
        lit.forEachSpan(lattice_.axes(), v, slice[k] - place.z, [&](int begin, int behind) {
          if (stride[0] == 1) {
            for (std::size_t i = k; i < end; ++i) {
              std::int32_t* const sum = to + layer[i];
              const std::int32_t* const added = from[i];
              for (int u = begin; u < behind; ++u) sum[u] += added[u];
            }
          } else {
            for (int u = begin; u < behind; ++u)
              for (std::size_t i = k; i < end; ++i) to[u * stride[0] + layer[i]] += from[i][u];
          }
        });
        k = end;
      }
    }
  }
}

}  // namespace umbrick
