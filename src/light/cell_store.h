// Blocks of numbers, one for each visible brick, in the order in which a sweep along one axis meets them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "umbrick/brick/bricks.h"
#include "umbrick/light/light_paths.h"

namespace umbrick {

/// A part of a plane, half-open.
struct PlaneWindow {
  int u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  void include(const PlaneWindow& other) {
    u0 = std::min(u0, other.u0);
    u1 = std::max(u1, other.u1);
    v0 = std::min(v0, other.v0);
    v1 = std::max(v1, other.v1);
  }
  bool empty() const { return u0 >= u1 || v0 >= v1; }
};

/// Where a brick holds light: at every voxel, or at every second one along each axis.
struct LightLayout {
  int spacing = 1;         // voxels between places of light, 1 or 2
  glm::ivec3 interior{0};  // owned places along each axis
  int apron = 1;           // places on each side, so that light can be interpolated at ghost voxels
  glm::ivec3 edge() const { return interior + 2 * apron; }
  std::size_t places() const {
    const glm::ivec3 e = edge();
    return static_cast<std::size_t>(e.x) * static_cast<std::size_t>(e.y) * static_cast<std::size_t>(e.z);
  }
};
inline LightLayout lightLayout(const BrickLayout& bricks, int spacing) {
  return {spacing, bricks.interior / spacing, spacing == 1 ? bricks.apron : bricks.apron / 2 + 1};
}

/// Which parts of a brick get light: blocks of kEdge voxels along each axis that have medium in them or next to them.
/// Voxels of the apron belong to the brick's outer blocks.
class LitBlocks {
 public:
  static constexpr int kEdge = 4;
  LitBlocks(const BrickLayout& layout, const LightLayout& light)
      : interior_(layout.interior),
        apron_(layout.apron),
        light_(light),
        count_((layout.interior + kEdge - 1) / kEdge),
        lit_(static_cast<std::size_t>(count_.x) * static_cast<std::size_t>(count_.y) *
             static_cast<std::size_t>(count_.z)),
        row_(static_cast<std::size_t>(count_.x)) {}
  /// Marks what lies around the space between four rows of voxels: y and y + 1, z and z + 1, from -apron on.
  /// @param medium  whether there is any between voxels x and x + 1, for x from -apron on
  /// @param around  voxels that are marked beyond those next to the medium
  void markRow(const char* medium, int y, int z, int around = 0);
  void markAll() { std::ranges::fill(lit_, char{1}); }
  /// Calls visit(begin, end) for the places of a row along u that get light.
  /// @param v  row of places  n  slice of voxels; both count from the brick's first owned ones
  template <class Visit>
  void forEachSpan(const SweepAxes& axes, int v, int n, const Visit& visit) const;
  /// Returns the box of the voxels of a slab of slices that get light, grown by a margin, counted from the brick's
  /// first owned one; empty where there are none.
  PlaneWindow around(const SweepAxes& axes, int first, int last, int margin) const;
  /// A number that is the same for slices of voxels whose rows have light at the same places.
  int layerOf(const SweepAxes& axes, int n) const { return blockOf(n, count_[axes.n]); }

 private:
  static int blockOf(int voxel, int count) { return std::clamp(voxel / kEdge, 0, count - 1); }
  std::ptrdiff_t stride(int axis) const {
    return axis == 0 ? 1 : axis == 1 ? count_.x : std::ptrdiff_t(count_.x) * count_.y;
  }
  glm::ivec3 interior_;
  int apron_;
  LightLayout light_;
  glm::ivec3 count_;
  std::vector<char> lit_;
  std::vector<char> row_;  // what markRow() finds along x
};

template <class Visit>
void LitBlocks::forEachSpan(const SweepAxes& axes, int v, int n, const Visit& visit) const {
  const char* row = lit_.data() + blockOf(v * light_.spacing, count_[axes.v]) * stride(axes.v) +
                    blockOf(n, count_[axes.n]) * stride(axes.n);
  const int blocks = count_[axes.u], perBlock = kEdge / light_.spacing;
  for (int u = 0; u < blocks; ++u)
    if (row[u * stride(axes.u)])
      visit(u == 0 ? -light_.apron : u * perBlock,
            u + 1 == blocks ? light_.interior[axes.u] + light_.apron : (u + 1) * perBlock);
}

/// Calls visit(first, place, count) for the rows of places of a brick whose light is known.
/// @note first: the place that a row begins with, counted from the brick's first owned one; place: its number in the
///       brick, x fastest
template <class Visit>
void forEachRow(const LitBlocks& lit, const LightLayout& light, const Visit& visit) {
  const glm::ivec3 edge = light.edge();
  std::size_t row = 0;
  for (int z = -light.apron; z < light.interior.z + light.apron; ++z)
    for (int y = -light.apron; y < light.interior.y + light.apron; ++y, row += static_cast<std::size_t>(edge.x))
      lit.forEachSpan(kSweepAxes[2], y, z * light.spacing, [&](int begin, int end) {
        visit(glm::ivec3(begin, y, z), row + static_cast<std::size_t>(begin + light.apron),
              static_cast<std::size_t>(end - begin));
      });
}

/// A half-open part of a row.
struct Span {
  int begin = 0, end = 0;
};

/// The spans of the rows of a slice.
class RowSpans {
 public:
  void reset(int rows) {
    rows_.resize(static_cast<std::size_t>(rows));
    for (auto& row : rows_) row.clear();
  }
  int rows() const { return static_cast<int>(rows_.size()); }
  void add(int row, const Span& span) { rows_[static_cast<std::size_t>(row)].push_back(span); }
  const std::vector<Span>& operator[](int row) const { return rows_[static_cast<std::size_t>(row)]; }
  /// Sorts the spans of each row and joins those that are at most `gap` apart.
  void join(int gap);
  std::size_t length() const;

 private:
  std::vector<std::vector<Span>> rows_;
};

/// Where the bricks lie that a sweep along one axis goes through. Planes hold the voxels of a slice, or the places of
/// light on it: their rows and columns count from the same corner, of which voxels have `spacing` times as many.
class SweepLattice {
 public:
  /// @param origins  first owned voxel of each brick
  SweepLattice(int axis, const std::vector<glm::ivec3>& origins, const BrickLayout& layout, const LightLayout& light);

  SweepAxes axes() const { return axes_; }
  int spacing() const { return light_.spacing; }
  /// First and last slice that light is wanted near.
  int firstSlice() const { return low_[2] - reach(); }
  int lastSlice() const { return high_[2] + reach(); }
  bool hasLight(int n) const { return (n - low_[2]) % light_.spacing == 0; }
  /// The voxel in the corner of a plane.
  int columnOrigin() const { return low_[0] - margin() * light_.spacing; }
  int rowOrigin() const { return low_[1] - margin() * light_.spacing; }
  /// Places of light in a plane.
  int width() const { return (high_[0] - low_[0] + 1) / light_.spacing + 2 * margin(); }
  int height() const { return (high_[1] - low_[1] + 1) / light_.spacing + 2 * margin(); }

  /// Calls visit(brick, place) for each brick with voxels at most `beyond` outside of the slices first, ..., last;
  /// place: in (u, v, n), its first owned voxel.
  template <class Visit>
  void forEachBrick(int first, int last, int beyond, const Visit& visit) const;
  /// A number that is the same for slices that meet the same bricks and their neighbourhood.
  int kindOf(int n) const;
  glm::ivec3 interior() const { return interior_; }                        // voxels along u, v, n
  glm::ivec3 lightInterior() const { return interior_ / light_.spacing; }  // places of light
  int apron() const { return apron_; }
  int lightApron() const { return light_.apron; }
  /// How far outside of a brick light is held, voxels.
  int reach() const { return light_.apron * light_.spacing; }

 private:
  // Paths around the outermost place, where they were on the slice before, and the voxels next to them.
  int margin() const { return light_.apron + 3; }
  struct Layer {
    int n;
    std::size_t begin, end;
  };
  SweepAxes axes_;
  glm::ivec3 interior_;
  int apron_;
  LightLayout light_;
  std::vector<int> order_;  // bricks by n, v, u
  std::vector<glm::ivec3> place_;
  std::vector<Layer> layers_;
  glm::ivec3 low_{0}, high_{0};
};

template <class Visit>
void SweepLattice::forEachBrick(int first, int last, int beyond, const Visit& visit) const {
  for (const Layer& layer : layers_)
    if (last >= layer.n - beyond && first < layer.n + interior_[2] + beyond)
      for (std::size_t i = layer.begin; i < layer.end; ++i) visit(order_[i], place_[i]);
}

}  // namespace umbrick
