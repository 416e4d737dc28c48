// SPDX-License-Identifier: Apache-2.0
#include "sweep/surface_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sweep/lattice_walk.h"
#include "umbrick/optics/bspline.h"

namespace umbrick {
namespace {

template <class Code>
CellCorners cornersOf(const Code* first, std::ptrdiff_t strideY, std::ptrdiff_t strideZ, double offset) {
  CellCorners corners;
  const std::ptrdiff_t places[4]{0, strideY, strideZ, strideY + strideZ};
  for (std::size_t i = 0; i < 4; ++i) {
    corners[2 * i] = offset + static_cast<double>(first[places[i]]);
    corners[2 * i + 1] = offset + static_cast<double>(first[places[i] + 1]);
  }
  return corners;
}

}  // namespace

SurfaceRays::SurfaceRays(const BrickVoxels& voxels, const BrickTable& table, const IndexBox& box,
                         std::span<const SceneSurface> surfaces, GradientFilter gradients)
    : voxels_(voxels), table_(table), box_(box), gradients_(gradients) {
  for (const SceneSurface& surface : surfaces) values_.push_back(surface.value);
  const auto [low, high] = std::ranges::minmax_element(values_);
  if (!values_.empty()) {
    lowest_ = *low;
    highest_ = *high;
  }
  const glm::ivec3 edge = voxels.volume().layout.edge();
  strideY_ = edge.x;
  strideZ_ = static_cast<std::ptrdiff_t>(edge.x) * edge.y;
  sides_.resize(values_.size());
}

void SurfaceRays::trace(const ValueRay& ray, const std::function<bool(const SurfaceHit&)>& visit) {
  if (!(ray.enter < ray.leave) || values_.empty()) return;
  ray_ = ray;
  inverse_ = 1.0 / ray.direction;
  visit_ = &visit;
  std::ranges::fill(sides_, Side::unknown);
  reached_ = -std::numeric_limits<double>::infinity();
  std::array<std::int64_t, 3> first;
  glm::dvec3 low;
  glm::i64vec3 count;
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    first[at] = table_.cellOf(box_.min[axis], axis);
    count[axis] = table_.cellOf(box_.max[axis], axis) - first[at] + 1;
    low[axis] = static_cast<double>(table_.firstOf(first[at], axis));
  }
  const glm::dvec3 edge(voxels_.volume().layout.interior);
  walkLattice(low, edge, count, ray_, inverse_, ray.enter, ray.leave,
              [&](const glm::i64vec3& cell, double enter, double leave) {
                const PlacedBrick* const entry = table_.find({first[0] + cell.x, first[1] + cell.y, first[2] + cell.z});
                return !entry || !entry->brick || !entry->brick->voxels || walkBrick(*entry, enter, leave);
              });
}

bool SurfaceRays::walkBrick(const PlacedBrick& entry, double enter, double leave) {
  constexpr int kGroup = BrickVoxels::kGroup;
  const glm::ivec3 groups = voxels_.groups(), interior = voxels_.volume().layout.interior;
  const glm::dvec3 origin(entry.origin);
  return walkLattice(origin, glm::dvec3(kGroup), groups, ray_, inverse_, enter, leave,
                     [&](const glm::ivec3& group, double from, double to) {
                       const auto number = (static_cast<std::size_t>(group.z) * static_cast<std::size_t>(groups.y) +
                                            static_cast<std::size_t>(group.y)) *
                                               static_cast<std::size_t>(groups.x) +
                                           static_cast<std::size_t>(group.x);
                       if (!entry.brick->active[number]) return true;
                       const glm::ivec3 cells = glm::min(glm::ivec3(kGroup), interior - kGroup * group);
                       return walkLattice(origin + glm::dvec3(kGroup * group), glm::dvec3(1), cells, ray_, inverse_,
                                          from, to, [&](const glm::ivec3& cell, double in, double out) {
                                            return walkCell(entry, kGroup * group + cell, in, out);
                                          });
                     });
}

CellCorners SurfaceRays::cornersAt(const VoxelBrick& brick, std::ptrdiff_t index) const {
  const double offset = voxels_.offset();
  switch (voxels_.code()) {
    case VoxelCode::u8:
      return cornersOf(BrickVoxels::codes<std::uint8_t>(brick) + index, strideY_, strideZ_, offset);
    case VoxelCode::u16:
      return cornersOf(BrickVoxels::codes<std::uint16_t>(brick) + index, strideY_, strideZ_, offset);
    case VoxelCode::f16:  // never: ValueRays hold floats of 32 bits
    case VoxelCode::f32:
      break;
  }
  return cornersOf(BrickVoxels::codes<float>(brick) + index, strideY_, strideZ_, offset);
}

bool SurfaceRays::walkCell(const PlacedBrick& entry, const glm::ivec3& cell, double enter, double leave) {
  ++cells_;
  const glm::ivec3 at = cell + voxels_.volume().layout.apron;
  const Place place{&entry, cell, at.z * strideZ_ + at.y * strideY_ + at.x};
  const CellCorners corners = cornersAt(*entry.brick, place.index);
  const auto [low, high] = std::ranges::minmax(corners);
  const bool adjacent = enter <= reached_ + 1e-12 * std::abs(reached_);
  const double gap = adjacent ? enter : reached_;  // where a side that has changed meanwhile changed
  reached_ = leave;
  if (high <= lowest_ || low > highest_) {
    const Side side = high <= lowest_ ? Side::below : Side::above;
    for (std::size_t k = 0; k < values_.size(); ++k) {
      if (sides_[k] != Side::unknown && sides_[k] != side && !tell(place, gap, k)) return false;
      sides_[k] = side;
    }
    return true;
  }
  const glm::dvec3 corner = glm::dvec3(entry.origin + cell);
  const CellCubic cubic = cubicBetween(corners, ray_.at(enter) - corner, ray_.at(leave) - corner);
  struct Crossing {
    double s;
    std::size_t surface;
  };
  std::array<Crossing, 3 * kMostSurfaces> crossings;
  std::size_t count = 0;
  for (std::size_t k = 0; k < values_.size(); ++k) {
    const Side here = cubic(0) > values_[k] ? Side::above : Side::below;
    if (sides_[k] != Side::unknown && !adjacent && sides_[k] != here && !tell(place, gap, k)) return false;
    const Side from = sides_[k] == Side::unknown || !adjacent ? here : sides_[k];
    const CellCrossings found = crossingsOf(cubic, values_[k], from == Side::above);
    for (int i = 0; i < found.count; ++i) crossings[count++] = {found.places[static_cast<std::size_t>(i)], k};
    sides_[k] = found.above ? Side::above : Side::below;
  }
  if (values_.size() > 1)
    std::sort(crossings.begin(), crossings.begin() + static_cast<std::ptrdiff_t>(count),
              [](const Crossing& a, const Crossing& b) { return a.s < b.s; });
  for (std::size_t i = 0; i < count; ++i)
    if (!tell(place, enter + crossings[i].s * (leave - enter), crossings[i].surface)) return false;
  return true;
}

bool SurfaceRays::tell(const Place& place, double t, std::size_t surface) {
  const glm::dvec3 local = ray_.at(t) - glm::dvec3(place.entry->origin + place.cell);
  const glm::dvec3 inCell = glm::clamp(local, 0.0, 1.0);
  return (*visit_)({t, surface, gradientAt(place, inCell), place.entry->brick, glm::dvec3(place.cell) + inCell});
}

// The difference of the values a voxel away on both sides. Values between voxels are sums of those at voxels, so that
// this is the central difference at voxels, interpolated.
glm::dvec3 SurfaceRays::gradientAt(const Place& place, const glm::dvec3& p) const {
  if (gradients_ == GradientFilter::bspline) return splineGradientAt(place, p);
  const std::ptrdiff_t strides[3]{1, strideY_, strideZ_};
  const auto valueAt = [&](std::ptrdiff_t index) {
    const CellCorners v = cornersAt(*place.entry->brick, index);
    const auto mix = [](double a, double b, double share) { return a + share * (b - a); };
    return mix(mix(mix(v[0], v[1], p.x), mix(v[2], v[3], p.x), p.y),
               mix(mix(v[4], v[5], p.x), mix(v[6], v[7], p.x), p.y), p.z);
  };
  glm::dvec3 gradient;
  for (int axis = 0; axis < 3; ++axis)
    gradient[axis] = 0.5 * (valueAt(place.index + strides[axis]) - valueAt(place.index - strides[axis]));
  return gradient;
}

// The gradient of the tricubic B-spline, of the 4 x 4 x 4 voxels around the cell: the corners of the eight cells that
// begin at every second one of them.
glm::dvec3 SurfaceRays::splineGradientAt(const Place& place, const glm::dvec3& p) const {
  const double here = cornersAt(*place.entry->brick, place.index)[0];  // differences from it have more digits
  std::array<glm::dvec4, 3> weights, slopes;
  for (int axis = 0; axis < 3; ++axis) {
    weights[static_cast<std::size_t>(axis)] = bsplineWeights(static_cast<float>(p[axis]));
    slopes[static_cast<std::size_t>(axis)] = bsplineSlopes(static_cast<float>(p[axis]));
  }
  glm::dvec3 gradient(0);
  for (int k = 0; k < 4; k += 2)
    for (int j = 0; j < 4; j += 2)
      for (int i = 0; i < 4; i += 2) {
        const CellCorners corners =
            cornersAt(*place.entry->brick, place.index + (k - 1) * strideZ_ + (j - 1) * strideY_ + i - 1);
        for (int corner = 0; corner < 8; ++corner) {
          const int x = i + (corner & 1), y = j + (corner >> 1 & 1), z = k + (corner >> 2);
          gradient +=
              (corners[static_cast<std::size_t>(corner)] - here) *
              glm::dvec3(slopes[0][x] * weights[1][y] * weights[2][z], weights[0][x] * slopes[1][y] * weights[2][z],
                         weights[0][x] * weights[1][y] * slopes[2][z]);
        }
      }
  return gradient;
}

}  // namespace umbrick
