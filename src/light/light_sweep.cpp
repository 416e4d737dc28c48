// SPDX-License-Identifier: Apache-2.0
#include "light/light_sweep.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "light/sweep_kernels.h"

namespace umbrick {
namespace {

// A lattice is held in a plane that is larger by so many texels along each axis, and moved when paths have moved so
// far.
constexpr int kSlack = 64;

/// The optical depths of the paths of one direction.
class PathLattice {
 public:
  PathLattice(const SweptDirection& direction, int width, int height)
      : direction_(direction),
        width_(width + kSlack),
        height_(height + kSlack),
        depth_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0.0f),
        offset_{direction.u > 0 ? kSlack : 0, direction.v > 0 ? kSlack : 0} {}

  const SweptDirection& direction() const { return direction_; }

  /// Moves on to slice n. Where paths lie between voxels depends on n alone, so that it is the same however the volume
  /// is cut into bricks.
  void moveTo(int n) {
    const double slices = -direction_.sign * static_cast<double>(n);
    const double u = slices * direction_.u, v = slices * direction_.v;
    const int wholeU = static_cast<int>(std::floor(u)), wholeV = static_cast<int>(std::floor(v));
    u_ = static_cast<float>(u - wholeU);
    v_ = static_cast<float>(v - wholeV);
    const int shiftU = rebased(offset_[0], wholeU), shiftV = rebased(offset_[1], wholeV);
    if (shiftU != 0 || shiftV != 0) shift(shiftU, shiftV);
    moved_ = {wholeU - whole_[0], wholeV - whole_[1]};
    whole_ = {wholeU, wholeV};
  }
  /// Where the paths lie between the voxels of the slice, in [0, 1).
  float u() const { return u_; }
  float v() const { return v_; }
  /// By how many voxels paths have moved in the last move, before what u() and v() say.
  const std::array<int, 2>& moved() const { return moved_; }
  /// Returns the path of the row that lies at or just below this column of the plane of voxels.
  float* row(int row, int column) {
    const std::ptrdiff_t v = row - whole_[1] + offset_[1], u = column - whole_[0] + offset_[0];
    return depth_.data() + v * width_ + u;
  }

 private:
  // Returns by how much to move what the plane holds, so that the place of the first column stays in [0, kSlack].
  static int rebased(int& offset, int whole) {
    const int place = offset - whole;
    const int steps = place < 0 ? (kSlack - 1 - place) / kSlack : place > kSlack ? -((place - 1) / kSlack) : 0;
    const int shift = steps * kSlack;
    offset += shift;
    return shift;
  }
  void shift(int u, int v) {
    std::vector<float> moved(depth_.size(), 0.0f);
    const int first = std::max(0, u), last = std::min(width_, width_ + u);
    for (int row = std::max(0, v); row < std::min(height_, height_ + v); ++row)
      std::copy_n(depth_.data() + std::ptrdiff_t(row - v) * width_ + first - u, last - first,
                  moved.data() + std::ptrdiff_t(row) * width_ + first);
    depth_.swap(moved);
  }

  SweptDirection direction_;
  int width_, height_;
  std::vector<float> depth_;
  std::array<int, 2> offset_, whole_{}, moved_{};
  float u_ = 0, v_ = 0;
};

/// A plane of numbers that go with the voxels of a slice.
struct Plane {
  int width = 0;
  std::vector<float> numbers;
  Plane(int columns, int rows)
      : width(columns), numbers(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0.0f) {}
  float* row(int r, int column) { return numbers.data() + std::ptrdiff_t(r) * width + column; }
};

/// A sweep of a few directions.
class Sweep {
 public:
  Sweep(SweptBricks& bricks, const std::vector<SweptDirection>& directions)
      : bricks_(bricks),
        lattice_(bricks.lattice),
        sign_(directions.front().sign),
        values_{Plane(lattice_.width(), lattice_.height()), Plane(lattice_.width(), lattice_.height())},
        through_{std::vector<float>(static_cast<std::size_t>(lattice_.width())),
                 std::vector<float>(static_cast<std::size_t>(lattice_.width()))} {
    for (int c = 0; c < bricks.channels; ++c) light_.emplace_back(lattice_.width(), lattice_.height());
    for (const SweptDirection& direction : directions)
      paths_.emplace_back(direction, lattice_.width(), lattice_.height());
  }

  std::uint64_t run() {
    const int slices = lattice_.lastSlice() - lattice_.firstSlice() + 1;
    for (int step = 0; step < slices; ++step) {
      const int n = sign_ > 0 ? lattice_.lastSlice() - step : lattice_.firstSlice() + step;
      findRows(n);
      if (rows_.length() == 0) continue;
      // Light comes from the slice before, which mostly is the last that was looked at.
      values_[0].numbers.swap(values_[1].numbers);
      if (last_ != n + sign_) copyValues(n + sign_, values_[0]);
      copyValues(n, values_[1]);
      last_ = n;
      for (PathLattice& path : paths_) {
        path.moveTo(n + sign_);
        before_ = {nullptr, nullptr, path.u(), path.v()};
        path.moveTo(n);
        carry(path, n);
      }
      addLight(n);
    }
    return updates_;
  }

 private:
  // Finds the voxels of a slice that get light, and the paths around them.
  void findRows(int n) {
    const int kind = lattice_.kindOf(n);
    if (kind == kind_) return;
    kind_ = kind;
    const int height = lattice_.height();
    rows_.reset(height);
    const glm::ivec3 interior = lattice_.interior();
    const int apron = lattice_.apron();
    lattice_.forEachBrick(n, apron, [&](int brick, const glm::ivec3& place) {
      const int u = place.x - lattice_.columnOrigin(), v = place.y - lattice_.rowOrigin();
      for (int row = -apron; row < interior.y + apron; ++row)
        (*bricks_.lit)[static_cast<std::size_t>(brick)].forEachSpan(lattice_.axes(), row, n - place.z,
                                                                    [&](int begin, int end) {
                                                                      rows_.add(v + row, {u + begin, u + end});
                                                                    });
    });
    rows_.join();
    pathRows_.reset(height);
    for (int row = 0; row + 1 < height; ++row)
      for (int next = row; next < row + 2; ++next)
        for (const Span& span : rows_[next]) pathRows_.add(row, {span.begin - 1, span.end});
    pathRows_.join();
  }

  // Puts the values of the bricks on this slice into a plane. Beyond the apron of a brick, where there is no medium,
  // values are the same as on the brick's side, so that no path meets a value that nothing has.
  void copyValues(int n, Plane& plane) {
    const int apron = lattice_.apron();
    const glm::ivec3 edge = lattice_.interior() + 2 * apron;
    const std::ptrdiff_t slice = std::ptrdiff_t(edge.x) * edge.y;
    const auto put = [&](int brick, const glm::ivec3& place, int layer, int beyond) {
      const float* from = bricks_.values + (std::ptrdiff_t(brick) * edge.z + layer) * slice;
      for (int v = -beyond; v < edge.y + beyond; ++v) {
        const float* row = from + std::clamp(v, 0, edge.y - 1) * edge.x;
        float* to = plane.row(place.y - apron + v - lattice_.rowOrigin(), place.x - apron - lattice_.columnOrigin());
        std::copy_n(row, edge.x, to);
        std::fill_n(to - beyond, beyond, row[0]);
        std::fill_n(to + edge.x, beyond, row[edge.x - 1]);
      }
    };
    lattice_.forEachBrick(n, apron + 1, [&](int brick, const glm::ivec3& place) {
      put(brick, place, std::clamp(n - place.z + apron, 0, edge.z - 1), 2);
    });
    lattice_.forEachBrick(n, apron,
                          [&](int brick, const glm::ivec3& place) { put(brick, place, n - place.z + apron, 0); });
  }

  // Takes the paths of one direction through a slice, and gives its voxels the light of it.
  void carry(PathLattice& path, int n) {
    int before = -2;  // the row that through_[0] holds
    for (int row = 0; row + 1 < lattice_.height(); ++row) {
      const std::vector<Span>& spans = pathRows_[row];
      if (spans.empty()) continue;
      for (const Span& span : spans) carrySpan(path, n, row, span);
      if (before == row - 1)
        for (const Span& span : rows_[row])
          for (int c = 0; c < bricks_.channels; ++c)
            addRow(through_[0].data() + span.begin, through_[1].data() + span.begin, path.u(), path.v(),
                   path.direction().weight[static_cast<std::size_t>(c)],
                   light_[static_cast<std::size_t>(c)].row(row, span.begin), span.end - span.begin);
      before = row;
      through_[0].swap(through_[1]);
    }
  }

  void carrySpan(PathLattice& path, int n, int row, const Span& span) {
    const int count = span.end - span.begin;
    updates_ += static_cast<std::uint64_t>(count);
    float* depth = path.row(row, span.begin);
    float* through = through_[1].data() + span.begin;
    const PathRow here{values_[1].row(row, span.begin), values_[1].row(row + 1, span.begin), path.u(), path.v()};
    const int rowBefore = row - path.moved()[1], columnBefore = span.begin - path.moved()[0];
    before_.near = values_[0].row(rowBefore, columnBefore);
    before_.far = values_[0].row(rowBefore + 1, columnBefore);
    const SweptDirection& direction = path.direction();
    const ExtinctionTable& table = *bricks_.extinction;
    const PathMedium medium{table.integrals(),  table.below(),      table.above(),
                            table.emptyBelow(), table.emptyAbove(), static_cast<float>(direction.length)};
    if (bricks_.planes.empty()) return carryRow(before_, here, medium, depth, through, count);
    cuts_.clear();
    const glm::dvec3 place(lattice_.columnOrigin() + span.begin + path.u(), lattice_.rowOrigin() + row + path.v(), n);
    for (const glm::dvec4& plane : bricks_.planes) {
      double rate = plane.x * direction.u + plane.y * direction.v - plane.z * direction.sign;
      if (std::abs(rate) < 1e-6) rate = 1e-6;
      cuts_.push_back({static_cast<float>(glm::dot(glm::dvec3(plane), place) + plane.w), static_cast<float>(plane.x),
                       static_cast<float>(rate)});
    }
    carryCutRow(before_, here, medium, cuts_.data(), static_cast<int>(cuts_.size()), depth, through, count);
  }

  // Adds the light of the slice to the bricks and sets the plane back to 0.
  void addLight(int n) {
    const int apron = lattice_.apron();
    const glm::ivec3 interior = lattice_.interior(), edge = interior + 2 * apron;
    const std::ptrdiff_t slice = std::ptrdiff_t(edge.x) * edge.y;
    const std::scoped_lock lock(bricks_.busy[static_cast<std::size_t>(n - lattice_.firstSlice())]);
    lattice_.forEachBrick(n, apron, [&](int brick, const glm::ivec3& place) {
      for (int c = 0; c < bricks_.channels; ++c) {
        std::int32_t* to =
            bricks_.light + ((std::ptrdiff_t(brick) * bricks_.channels + c) * edge.z + n - place.z + apron) * slice;
        for (int v = -apron; v < interior.y + apron; ++v, to += edge.x) {
          const float* from = light_[static_cast<std::size_t>(c)].row(place.y + v - lattice_.rowOrigin(),
                                                                      place.x - apron - lattice_.columnOrigin());
          (*bricks_.lit)[static_cast<std::size_t>(brick)].forEachSpan(
              lattice_.axes(), v, n - place.z, [&](int begin, int end) {
                for (int u = begin + apron; u < end + apron; ++u)
                  to[u] += static_cast<std::int32_t>(from[u] * kWholeLight + 0.5f);
              });
        }
      }
    });
    for (Plane& plane : light_)
      for (int row = 0; row < rows_.rows(); ++row)
        for (const Span& span : rows_[row]) std::fill_n(plane.row(row, span.begin), span.end - span.begin, 0.0f);
  }

  SweptBricks& bricks_;
  const SweepLattice& lattice_;
  int sign_;
  std::vector<PathLattice> paths_;
  std::array<Plane, 2> values_;                // of the slice before and of this one
  PathRow before_;                             // the present path on the slice before
  std::vector<Plane> light_;                   // by channel
  std::array<std::vector<float>, 2> through_;  // transmittances of two neighbouring rows of paths
  RowSpans rows_, pathRows_;
  int kind_ = -1;
  int last_ = std::numeric_limits<int>::min();  // the slice whose values values_[1] has
  std::vector<RowPlane> cuts_;
  std::uint64_t updates_ = 0;
};

}  // namespace

std::uint64_t sweepLight(SweptBricks& bricks, const std::vector<SweptDirection>& directions) {
  return Sweep(bricks, directions).run();
}

}  // namespace umbrick
