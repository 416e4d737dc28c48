// SPDX-License-Identifier: Apache-2.0
#include "light/light_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "light/mesh_shadow.h"
#include "light/sweep_kernels.h"

namespace umbrick {
namespace {

/// The paths of one direction, and where they are on the present slice.
struct Paths {
  SweptDirection direction;
  PathLattice lattice;
  PathMedium medium;
  PathShare share;
  PlaneWindow within;  // the paths that are followed; all where `bounded` is false
  bool bounded = false;
  PathPlace u, v, beforeU, beforeV;  // on this slice and on the one before
  // Transmittances of the present row of paths and of the one before.
  std::array<std::vector<float>, 2> through;
  int held = -2;                        // the row that `through` holds
  std::optional<MeshShadow> mesh = {};  // none: there is no mesh
};

class Sweep {
 public:
  Sweep(SweptBricks& bricks, const SweepTask& task)
      : bricks_(bricks),
        task_(task),
        lattice_(task.directions.front().axis, bricks.origins, bricks.layout, bricks.light),
        spacing_(lattice_.spacing()),
        sign_(task.directions.front().sign),
        origin_{lattice_.columnOrigin() / spacing_, lattice_.rowOrigin() / spacing_},
        values_(bricks, lattice_),
        light_(bricks, lattice_) {
    const ExtinctionTable& table = *bricks.extinction;
    const std::vector<float> none(static_cast<std::size_t>(lattice_.width()) + kRowPadding, 0.0f);
    for (std::size_t i = 0; i < task.directions.size(); ++i) {
      const SweptDirection& direction = task.directions[i];
      Paths paths{direction,    {direction, lattice_.width(), lattice_.height(), kRowPadding},
                  {},           {},
                  {},           false,
                  {},           {},
                  {},           {},
                  {none, none}, -2};
      paths.medium = {table.integrals(),
                      table.means(),
                      table.below(),
                      table.above(),
                      table.emptyBelow(),
                      table.emptyAbove(),
                      static_cast<float>(direction.length),
                      bricks.surfaces.data(),
                      static_cast<int>(bricks.surfaces.size())};
      for (std::size_t c = 0; c < 3; ++c) paths.share.weight[c] = task.factor * direction.weight[c] * kWholeLight;
      if (!task.paths.empty()) {
        paths.within = task.paths[i];
        paths.bounded = true;
      }
      if (bricks.mesh) paths.mesh.emplace(*bricks.mesh, direction, followed(direction), spacing_);
      paths_.push_back(std::move(paths));
    }
  }

  std::uint64_t run() {
    const int slices = lattice_.lastSlice() - lattice_.firstSlice() + 1;
    for (int step = 0; step < slices; ++step) {
      const int n = sign_ > 0 ? lattice_.lastSlice() - step : lattice_.firstSlice() + step;
      findRows(n);
      if (length_ == 0) continue;
      const PlaneWindow window = moveTo(n);
      if (window.empty()) continue;
      values_.require(n + sign_, window);
      values_.require(n, window);
      const bool lit = lattice_.hasLight(n) && (!task_.firstLit || sign_ * n <= sign_ * *task_.firstLit);
      if (lit) light_.begin(n);
      for (int row = std::max(window.v0, 0); row < std::min(window.v1, lattice_.height() - 1); ++row)
        if (!pathRows_[row].empty())
          for (Paths& paths : paths_) carry(paths, n, row, lit);
      if (lit) light_.end(n, window);
    }
    light_.finish();
    return updates_;
  }

 private:
  // Returns the paths that are in the plane on any slice.
  PlaneWindow followed(const SweptDirection& direction) const {
    const auto on = [&](int n) {
      const int u = origin_[0] - pathPlace(sign_, direction.u, spacing_, n).whole;
      const int v = origin_[1] - pathPlace(sign_, direction.v, spacing_, n).whole;
      return PlaneWindow{u, u + lattice_.width(), v, v + lattice_.height()};
    };
    PlaneWindow all = on(lattice_.firstSlice());
    all.include(on(lattice_.lastSlice()));
    return all;
  }

  // Finds the places of a slice that get light, and the paths around them.
  void findRows(int n) {
    const int kind = lattice_.kindOf(n);
    if (kind == kind_) return;
    kind_ = kind;
    const int height = lattice_.height();
    rows_.reset(height);
    const glm::ivec3 interior = lattice_.lightInterior();
    const int apron = lattice_.lightApron();
    lattice_.forEachBrick(n, n, lattice_.reach(), [&](int brick, const glm::ivec3& place) {
      const int u = (place.x - lattice_.columnOrigin()) / spacing_, v = (place.y - lattice_.rowOrigin()) / spacing_;
      for (int row = -apron; row < interior.y + apron; ++row)
        bricks_.lit[static_cast<std::size_t>(brick)].forEachSpan(lattice_.axes(), row, n - place.z,
                                                                 [&](int begin, int end) {
                                                                   rows_.add(v + row, {u + begin, u + end});
                                                                 });
    });
    // Spans that are near to each other are one, since loops over long rows are faster. Values are known between them
    // as far as bricks are continued.
    const int gap = spacing_ == 1 ? LitBlocks::kEdge : 0;
    rows_.join(gap);
    pathRows_.reset(height);
    for (int row = 0; row + 1 < height; ++row)
      for (int next = row; next < row + 2; ++next)
        for (const Span& span : rows_[next]) pathRows_.add(row, {span.begin - 1, span.end});
    pathRows_.join(gap);
    length_ = rows_.length();
  }

  // Moves the paths to a slice. @return the places that any of them are followed around
  PlaneWindow moveTo(int n) {
    PlaneWindow window{lattice_.width(), 0, lattice_.height(), 0};
    for (Paths& paths : paths_) {
      const SweptDirection& d = paths.direction;
      paths.beforeU = pathPlace(sign_, d.u, spacing_, n + sign_);
      paths.beforeV = pathPlace(sign_, d.v, spacing_, n + sign_);
      paths.u = pathPlace(sign_, d.u, spacing_, n);
      paths.v = pathPlace(sign_, d.v, spacing_, n);
      paths.lattice.moveTo(paths.u.whole, paths.v.whole);
      paths.share.u = static_cast<float>(paths.u.share);
      paths.share.v = static_cast<float>(paths.v.share);
      paths.held = -2;
      window.include(windowOf(paths));
    }
    return window;
  }
  // Columns and rows of paths that are followed on the present slice: those whose light is added, and their neighbours.
  PlaneWindow windowOf(const Paths& paths) const {
    if (!paths.bounded) return {0, lattice_.width(), 0, lattice_.height()};
    const PlaneWindow& w = paths.within;
    const int u = paths.u.whole - origin_[0], v = paths.v.whole - origin_[1];
    return {std::max(w.u0 - 1 + u, 0), std::min(w.u1 + 1 + u, lattice_.width()), std::max(w.v0 - 1 + v, 0),
            std::min(w.v1 + 1 + v, lattice_.height())};
  }

  // Takes a row of paths to the slice, and gives the places between it and the row before their light.
  void carry(Paths& paths, int n, int row, bool lit) {
    const PlaneWindow window = windowOf(paths);
    if (row < window.v0 || row >= window.v1) return;
    for (const Span& span : pathRows_[row]) {
      const Span part{std::max(span.begin, window.u0), std::min(span.end, window.u1)};
      if (part.begin < part.end) carrySpan(paths, n, row, part, lit);
    }
    if (lit && paths.held == row - 1)
      for (const Span& span : rows_[row]) {
        const int begin = std::max(span.begin, window.u0 + 1), end = std::min(span.end, window.u1);
        if (begin >= end) continue;
        std::array<std::int32_t*, 3> light{};
        for (int c = 0; c < bricks_.channels; ++c) light[static_cast<std::size_t>(c)] = light_.row(n, c, row, begin);
        addRow(paths.through[0].data() + begin, paths.through[1].data() + begin, paths.share, bricks_.channels,
               light.data(), end - begin);
      }
    paths.held = row;
    paths.through[0].swap(paths.through[1]);
  }

  void carrySpan(Paths& paths, int n, int row, const Span& span, bool lit) {
    const int count = span.end - span.begin;
    updates_ += static_cast<std::uint64_t>(count);
    const PathRow here = rowAt(n, row, span.begin, paths.u, paths.v);
    const PathRow before = rowAt(n + sign_, row + paths.beforeV.whole - paths.v.whole,
                                 span.begin + paths.beforeU.whole - paths.u.whole, paths.beforeU, paths.beforeV);
    float* const depth = paths.lattice.row(row, span.begin);
    if (paths.mesh)
      paths.mesh->darken(span.begin - paths.u.whole + origin_[0], row - paths.v.whole + origin_[1], n,
                         lattice_.hasLight(n), depth, count);
    float* const through = lit ? paths.through[1].data() + span.begin : nullptr;
    if (bricks_.planes.empty()) return carryRow(before, here, paths.medium, spacing_, depth, through, count);
    const SweptDirection& direction = paths.direction;
    const SweepAxes axes = lattice_.axes();
    const glm::dvec3 place(lattice_.columnOrigin() + (span.begin + paths.u.share) * spacing_,
                           lattice_.rowOrigin() + (row + paths.v.share) * spacing_, n);
    cuts_.clear();
    for (const glm::dvec4& plane : bricks_.planes) {
      const glm::dvec3 normal(plane[axes.u], plane[axes.v], plane[axes.n]);
      const PathCut cut = pathCut(plane, direction, bricks_.toIndex, spacing_);
      cuts_.push_back({static_cast<float>(glm::dot(normal, place) + plane.w), static_cast<float>(normal.x * spacing_),
                       static_cast<float>(cut.rate), static_cast<float>(cut.slicesPerPlace),
                       static_cast<float>(cut.cosine)});
    }
    carryCutRow(before, here, paths.medium, cuts_.data(), static_cast<int>(cuts_.size()), spacing_, depth, through,
                count);
  }

  PathRow rowAt(int n, int row, int column, const PathPlace& u, const PathPlace& v) {
    const int r = row * spacing_ + v.voxel(spacing_), c = column * spacing_ + u.voxel(spacing_);
    return {values_.row(n, r, c), values_.row(n, r + 1, c), u.behindVoxel(spacing_), v.behindVoxel(spacing_)};
  }

  SweptBricks& bricks_;
  const SweepTask& task_;
  SweepLattice lattice_;
  int spacing_, sign_;
  std::array<int, 2> origin_;  // the place in the corner of a plane
  ValuePlanes values_;
  LightPlanes light_;
  std::vector<Paths> paths_;
  RowSpans rows_, pathRows_;
  std::size_t length_ = 0;  // of rows_
  int kind_ = -1;
  std::vector<RowPlane> cuts_;
  std::uint64_t updates_ = 0;
};

}  // namespace

std::uint64_t sweepLight(SweptBricks& bricks, const SweepTask& task) { return Sweep(bricks, task).run(); }

}  // namespace umbrick
