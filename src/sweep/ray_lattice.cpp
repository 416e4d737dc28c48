// SPDX-License-Identifier: Apache-2.0
#include "sweep/ray_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace umbrick {
namespace {

// A single main axis serves rays that cross less than so many voxels on their way from one slice to the next.
constexpr double kSteepest = 1.75;

constexpr std::array<std::array<int, 3>, 3> kAxes{{{1, 2, 0}, {0, 2, 1}, {0, 1, 2}}};  // u, v, n by n

glm::dvec3 permuted(const glm::dvec3& p, const RayLattice& axes) { return {p[axes.u], p[axes.v], p[axes.n]}; }

int mainAxis(const glm::dvec3& direction) {
  int axis = 2;
  for (int other : {1, 0})
    if (std::abs(direction[other]) > std::abs(direction[axis])) axis = other;
  return axis;
}

std::array<glm::dvec2, 4> corners(const IndexView& view) {
  const glm::dvec2 h = view.halfExtent, c = view.centre;
  return {c + glm::dvec2(-h.x, -h.y), c + glm::dvec2(h.x, -h.y), c + glm::dvec2(-h.x, h.y), c + h};
}

glm::dvec3 directionOf(const IndexView& view, const glm::dvec2& p) {
  return view.projection == Projection::perspective ? view.toIndex[2] + view.toIndex[0] * p.x + view.toIndex[1] * p.y
                                                    : view.toIndex[2];
}

RayLattice alongAxis(const IndexView& view, const glm::dmat3& indexToWorld, int axis, int sign) {
  RayLattice lattice;
  const auto& axes = kAxes[static_cast<std::size_t>(axis)];
  lattice.u = axes[0];
  lattice.v = axes[1];
  lattice.n = axes[2];
  lattice.sign = sign;
  lattice.perspective = view.projection == Projection::perspective;
  lattice.eye = permuted(view.eyeIndex, lattice);
  for (std::size_t i = 0; i < 3; ++i) lattice.screen[i] = permuted(view.toIndex[i], lattice);
  const glm::dvec3 forward = lattice.screen[2];
  lattice.slope = glm::dvec2(forward) / forward.z;
  lattice.depth = {view.axis[static_cast<std::size_t>(lattice.u)].z, view.axis[static_cast<std::size_t>(lattice.v)].z,
                   view.axis[static_cast<std::size_t>(lattice.n)].z, view.origin.z};
  const glm::dmat3 columns(indexToWorld[lattice.u], indexToWorld[lattice.v], indexToWorld[lattice.n]);
  lattice.metric = glm::transpose(columns) * columns;
  return lattice;
}

// Returns where the lattice's coordinates have the ray through the middle of the picture; 0 where that runs across.
glm::dvec2 middleOf(const RayLattice& lattice, const IndexView& view) {
  const glm::dvec3 shift = lattice.screen[0] * view.centre.x + lattice.screen[1] * view.centre.y;
  if (lattice.perspective) {
    const glm::dvec3 along = shift + lattice.screen[2];
    const glm::dvec2 slopes = glm::dvec2(along) / along.z;
    return std::max(std::abs(slopes.x), std::abs(slopes.y)) < 4 ? slopes : glm::dvec2(0);
  }
  const glm::dvec3 o = lattice.eye + shift;
  return glm::dvec2(o) + lattice.slope * (lattice.reference - o.z);
}

// Returns the depth of a point of the view axis, so many voxels away along n.
double depthAlong(const RayLattice& lattice, double voxels) { return voxels / lattice.screen[2].z; }

// Gives the lattice its places: all that the screen and the box have in common.
// @return false: nothing
bool place(RayLattice& lattice, const IndexView& view, const Box& volume, const glm::dvec3& low, const glm::dvec3& high,
           const LatticeOptions& options, bool onlyMain) {
  const glm::dvec3 boxLow = permuted(low, lattice), boxHigh = permuted(high, lattice);
  // Where the lattice lies and how dense it is follows from the view and the volume, not from what is seen of it, so
  // that neither bricks nor transfer functions move rays.
  const glm::dvec3 volumeLow = permuted(volume.min, lattice), volumeHigh = permuted(volume.max, lattice);
  const auto inFront = [&](double from, double to) {
    double near = lattice.sign > 0 ? from : to;
    const double far = lattice.sign > 0 ? to : from;
    if (lattice.perspective) near = lattice.sign > 0 ? std::max(near, lattice.eye.z) : std::min(near, lattice.eye.z);
    return glm::dvec2(near, far);
  };
  const glm::dvec2 whole = inFront(volumeLow.z, volumeHigh.z), part = inFront(boxLow.z, boxHigh.z);
  const double nearest = part.x, farthest = part.y;
  if ((farthest - nearest) * lattice.sign <= 0 || (whole.y - whole.x) * lattice.sign <= 0) return false;
  lattice.reference = 0.5 * (whole.x + whole.y);
  // Where the lattice's coordinates lie that the box needs, and those that the screen sees.
  glm::dvec2 boxFirst(std::numeric_limits<double>::infinity()), boxLast(-boxFirst);
  const auto include = [](glm::dvec2& first, glm::dvec2& last, const glm::dvec2& p) {
    first = glm::min(first, p);
    last = glm::max(last, p);
  };
  if (lattice.perspective) {
    // Slopes towards the box, on its nearest and farthest planes; at the eye's own plane all slopes are met.
    for (const double n : {nearest, farthest})
      for (int corner = 0; corner < 4; ++corner) {
        const double distance = n - lattice.eye.z;
        const glm::dvec2 point(corner & 1 ? boxHigh.x : boxLow.x, corner & 2 ? boxHigh.y : boxLow.y);
        const glm::dvec2 offset = point - glm::dvec2(lattice.eye);
        if (std::abs(distance) > 1e-9)
          include(boxFirst, boxLast, offset / distance);
        else
          include(boxFirst, boxLast, glm::sign(offset) * (1e9 * lattice.sign));
      }
  } else {
    for (const double n : {nearest, farthest})
      for (int corner = 0; corner < 4; ++corner)
        include(boxFirst, boxLast,
                glm::dvec2(corner & 1 ? boxHigh.x : boxLow.x, corner & 2 ? boxHigh.y : boxLow.y) -
                    lattice.slope * (n - lattice.reference));
  }
  glm::dvec2 seenFirst(std::numeric_limits<double>::infinity()), seenLast(-seenFirst);
  bool seen = !lattice.perspective;
  for (const glm::dvec2& p : corners(view)) {
    if (lattice.perspective) {
      const glm::dvec3 d = directionOf(view, p);
      const glm::dvec3 along = lattice.screen[0] * p.x + lattice.screen[1] * p.y + lattice.screen[2];
      seen = seen || along.z * lattice.sign > 0;
      // Rays that run across the slices or backwards belong to other lattices.
      if (along.z * lattice.sign <= 1e-6 * glm::length(d)) {
        seenFirst = glm::dvec2(-1e9);
        seenLast = glm::dvec2(1e9);
      } else {
        include(seenFirst, seenLast, glm::dvec2(along) / along.z);
      }
    } else {
      const glm::dvec3 o = lattice.eye + lattice.screen[0] * p.x + lattice.screen[1] * p.y;
      include(seenFirst, seenLast, glm::dvec2(o) + lattice.slope * (lattice.reference - o.z));
    }
  }
  glm::dvec2 first = glm::max(boxFirst, seenFirst), last = glm::min(boxLast, seenLast);
  if (onlyMain) {
    first = glm::max(first, glm::dvec2(-1.0));
    last = glm::min(last, glm::dvec2(1.0));
  }
  if (!seen || !(first.x <= last.x && first.y <= last.y)) return false;
  const double middle = std::max(std::abs(lattice.reference - lattice.eye.z), 0.5);
  // Rays lie equally far apart along u and v in the world.
  const glm::dvec3 edges(std::sqrt(lattice.metric[0][0]), std::sqrt(lattice.metric[1][1]),
                         std::sqrt(lattice.metric[2][2]));
  double between = std::min({edges.x, edges.y, edges.z}) / options.raysPerVoxel;
  if (options.raysPerPixel > 0) {
    double pixel = 2 * view.halfExtent.y / view.size.y;
    if (lattice.perspective) pixel *= std::abs(depthAlong(lattice, middle));
    between = std::min(between, pixel / options.raysPerPixel);
  }
  glm::dvec2 step = between / glm::dvec2(edges) / (lattice.perspective ? middle : 1);
  step = glm::max(step, (last - first) / static_cast<double>(options.most - 8));
  // The ray through the middle of the picture is one of the lattice. The warp reads two rays beyond each place.
  constexpr double kMargin = 3;
  const glm::dvec2 middleRay = middleOf(lattice, view);
  const glm::dvec2 begin = glm::floor((first - middleRay) / step) - kMargin;
  const glm::dvec2 end = glm::ceil((last - middleRay) / step) + kMargin;
  lattice.width = static_cast<int>(end.x - begin.x) + 1;
  lattice.height = static_cast<int>(end.y - begin.y) + 1;
  const bool turned = lattice.perspective && lattice.sign < 0;
  lattice.step = turned ? -step : step;
  lattice.origin = middleRay + step * (turned ? end : begin);
  return true;
}

}  // namespace

glm::dvec3 RayLattice::placeOf(const glm::dvec2& p) const {
  if (perspective) {
    const glm::dvec3 along = static_cast<double>(sign) * (screen[0] * p.x + screen[1] * p.y + screen[2]);
    return {(glm::dvec2(along) - origin * along.z) / step, along.z};
  }
  const glm::dvec3 o = eye + screen[0] * p.x + screen[1] * p.y;
  return {(glm::dvec2(o) + slope * (reference - o.z) - origin) / step, 1};
}

std::vector<RayLattice> rayLattices(const IndexView& view, const glm::dmat3& indexToWorld, const Box& volume,
                                    const glm::dvec3& low, const glm::dvec3& high, const LatticeOptions& options) {
  const glm::dvec3 forward = directionOf(view, view.centre);
  const int axis = mainAxis(forward);
  const int sign = forward[axis] > 0 ? 1 : -1;
  double steepest = 0;
  for (const glm::dvec2& p : corners(view)) {
    const glm::dvec3 d = directionOf(view, p);
    if (!(d[axis] * sign > 0)) {
      steepest = std::numeric_limits<double>::infinity();
      break;
    }
    for (int other = 0; other < 3; ++other)
      if (other != axis) steepest = std::max(steepest, std::abs(d[other] / d[axis]));
  }
  std::vector<RayLattice> lattices;
  if (steepest <= kSteepest) {
    RayLattice lattice = alongAxis(view, indexToWorld, axis, sign);
    if (place(lattice, view, volume, low, high, options, false)) lattices.push_back(lattice);
    return lattices;
  }
  for (int n = 0; n < 3; ++n)
    for (const int towards : {1, -1}) {
      RayLattice lattice = alongAxis(view, indexToWorld, n, towards);
      if (place(lattice, view, volume, low, high, options, true)) lattices.push_back(lattice);
    }
  return lattices;
}

bool isMain(const RayLattice& lattice, const glm::dvec2& p) {
  const glm::dvec3 along = lattice.screen[0] * p.x + lattice.screen[1] * p.y + lattice.screen[2];
  return along.z * lattice.sign >= std::max(std::abs(along.x), std::abs(along.y)) * (1 - 1e-12);
}

}  // namespace umbrick
