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

namespace umbrick {

/// The axes of index space as a sweep sees them: u and v lie in its slices, u fastest in memory; n goes from slice to
/// slice.
struct SweepAxes {
  int u = 0, v = 1, n = 2;
};
inline constexpr SweepAxes kSweepAxes[3]{{1, 2, 0}, {0, 2, 1}, {0, 1, 2}};  // by n

/// Copies a block of x-fastest order to one of (u, v, n) order, or back. @param edge  along x, y and z
template <class Number, class Copy>
void permuteBlock(const SweepAxes& axes, const glm::ivec3& edge, Number* swept, Number* plain, const Copy& copy) {
  const std::ptrdiff_t stride[3]{1, edge.x, std::ptrdiff_t(edge.x) * edge.y};
  for (int n = 0; n < edge[axes.n]; ++n)
    for (int v = 0; v < edge[axes.v]; ++v) {
      Number* from = plain + n * stride[axes.n] + v * stride[axes.v];
      for (int u = 0; u < edge[axes.u]; ++u, ++swept, from += stride[axes.u]) copy(*swept, *from);
    }
}

/// Which parts of a brick get light: blocks of kEdge voxels along each axis that have medium in them or next to them.
/// Voxels of the apron belong to the brick's outer blocks.
class LitBlocks {
 public:
  static constexpr int kEdge = 4;
  LitBlocks(const glm::ivec3& interior, int apron)
      : interior_(interior),
        apron_(apron),
        count_((interior + kEdge - 1) / kEdge),
        lit_(static_cast<std::size_t>(count_.x) * static_cast<std::size_t>(count_.y) *
             static_cast<std::size_t>(count_.z)),
        row_(static_cast<std::size_t>(count_.x)) {}
  /// Marks what lies around the space between four rows of voxels: y and y + 1, z and z + 1, from -apron on.
  /// @param medium  whether there is any between voxels x and x + 1, for x from -apron on
  void markRow(const char* medium, int y, int z);
  /// Calls visit(begin, end) for the parts of a row along u that get light. @param v,n  of a voxel of the brick or its
  /// apron
  template <class Visit>
  void forEachSpan(const SweepAxes& axes, int v, int n, const Visit& visit) const;

 private:
  static int blockOf(int voxel, int count) { return std::clamp(voxel / kEdge, 0, count - 1); }
  std::ptrdiff_t stride(int axis) const {
    return axis == 0 ? 1 : axis == 1 ? count_.x : std::ptrdiff_t(count_.x) * count_.y;
  }
  glm::ivec3 interior_;
  int apron_;
  glm::ivec3 count_;
  std::vector<char> lit_;
  std::vector<char> row_;  // what markRow() finds along x
};

template <class Visit>
void LitBlocks::forEachSpan(const SweepAxes& axes, int v, int n, const Visit& visit) const {
  const char* row =
      lit_.data() + blockOf(v, count_[axes.v]) * stride(axes.v) + blockOf(n, count_[axes.n]) * stride(axes.n);
  const int blocks = count_[axes.u];
  for (int u = 0; u < blocks; ++u)
    if (row[u * stride(axes.u)])
      visit(u == 0 ? -apron_ : u * kEdge, u + 1 == blocks ? interior_[axes.u] + apron_ : (u + 1) * kEdge);
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
  /// Sorts the spans of each row and joins those that meet.
  void join();
  std::size_t length() const;

 private:
  std::vector<std::vector<Span>> rows_;
};

/// Where the bricks lie that a sweep along one axis goes through.
class SweepLattice {
 public:
  /// @param origins  first owned voxel of each brick
  SweepLattice(int axis, const std::vector<glm::ivec3>& origins, const BrickLayout& layout);

  SweepAxes axes() const { return axes_; }
  /// First and last slice that light is wanted on.
  int firstSlice() const { return low_[2] - apron_; }
  int lastSlice() const { return high_[2] + apron_; }
  /// Voxel (u, v) is in row v - rowOrigin() and column u - columnOrigin() of a plane of width() x height().
  int columnOrigin() const { return low_[0] - margin(); }
  int rowOrigin() const { return low_[1] - margin(); }
  int width() const { return high_[0] - low_[0] + 1 + 2 * margin(); }
  int height() const { return high_[1] - low_[1] + 1 + 2 * margin(); }

  /// Calls visit(brick, place) for each brick with voxels at most `beyond` outside of slice n; place: in (u, v, n), its
  /// first owned voxel.
  template <class Visit>
  void forEachBrick(int n, int beyond, const Visit& visit) const;
  /// A number that is the same for slices that meet the same bricks and their neighbourhood.
  int kindOf(int n) const;
  glm::ivec3 interior() const { return interior_; }  // along u, v, n
  int apron() const { return apron_; }

 private:
  // Paths around the outermost voxel, where they were on the slice before, and the voxels next to them.
  int margin() const { return apron_ + 3; }
  struct Layer {
    int n;
    std::size_t begin, end;
  };
  SweepAxes axes_;
  glm::ivec3 interior_;
  int apron_;
  std::vector<int> order_;  // bricks by n, v, u
  std::vector<glm::ivec3> place_;
  std::vector<Layer> layers_;
  glm::ivec3 low_{0}, high_{0};
};

template <class Visit>
void SweepLattice::forEachBrick(int n, int beyond, const Visit& visit) const {
  for (const Layer& layer : layers_)
    if (n >= layer.n - beyond && n < layer.n + interior_[2] + beyond)
      for (std::size_t i = layer.begin; i < layer.end; ++i) visit(order_[i], place_[i]);
}

}  // namespace umbrick
