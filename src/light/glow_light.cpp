// SPDX-License-Identifier: Apache-2.0
#include "light/glow_light.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <utility>

#include "umbrick/core/box.h"
#include "umbrick/light/light_paths.h"
#include "umbrick/optics/directions.h"

namespace umbrick {
namespace {

/// A function of one value at so many places between its ends, the nearest of which stands for a value: off by no more
/// than voxels differ within a cell.
class SampledFunction {
 public:
  explicit SampledFunction(const TransferFunction& function) {
    const double low = function.values().front(), high = function.values().back();
    low_ = static_cast<float>(low);
    perUnit_ = high > low ? static_cast<float>((kPlaces - 1) / (high - low)) : 0.0f;
    media_.reserve(kPlaces);
    for (int i = 0; i < kPlaces; ++i) {
      const Medium medium = function(low + (high - low) * i / (kPlaces - 1));
      media_.emplace_back(medium.sigma_s(), medium.sigma_t);
    }
  }
  /// sigma_s by colour, then sigma_t
  const glm::vec4& operator()(float value) const {
    const float place = (value - low_) * perUnit_ + 0.5f;
    return media_[static_cast<std::size_t>(std::clamp(place, 0.0f, static_cast<float>(kPlaces - 1)))];
  }

 private:
  static constexpr int kPlaces = 8192;
  float low_ = 0, perUnit_ = 0;
  std::vector<glm::vec4> media_;
};

/// Planes of cells with a margin of dark and empty ones, so that what lies one cell beside is always there.
class CellPlane {
 public:
  CellPlane(int width, int height)
      : stride_(width + 2), numbers_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height + 2), 0.0f) {}
  float* row(int v) { return numbers_.data() + std::ptrdiff_t(v + 1) * stride_ + 1; }
  const float* row(int v) const { return numbers_.data() + std::ptrdiff_t(v + 1) * stride_ + 1; }

 private:
  std::ptrdiff_t stride_;
  std::vector<float> numbers_;
};

constexpr std::size_t kExtinction = 3;  // the plane behind those of red, green and blue
using CellPlanes = std::array<CellPlane, 4>;

/// A direction, and its radiance on the slice that it has come to.
struct Beam {
  int u, v;                      // cells from a place to the first of the four that it comes from, on the slice before
  std::array<float, 4> weights;  // of these: (u, v), (u + 1, v), (u, v + 1), (u + 1, v + 1)
  float length;                  // between two slices, world units
  float weight;                  // of the direction
  std::array<CellPlane, 3> radiance, before;
};

Beam beamOf(const SweptDirection& direction, int cell, int width, int height) {
  // Paths lead from the light to the medium; what arrives here comes from the opposite offset on the slice before.
  const double du = -direction.u, dv = -direction.v;
  const double u = std::floor(du), v = std::floor(dv), fu = du - u, fv = dv - v;
  const CellPlane dark(width, height);
  return {static_cast<int>(u),
          static_cast<int>(v),
          {static_cast<float>((1 - fu) * (1 - fv)), static_cast<float>(fu * (1 - fv)),
           static_cast<float>((1 - fu) * fv), static_cast<float>(fu * fv)},
          static_cast<float>(direction.length * cell),
          direction.weight[0],
          {dark, dark, dark},
          {dark, dark, dark}};
}

// The mean of four cells. @param above  the row of the first two; below: of the others
inline float meanOf(const std::array<float, 4>& w, const float* above, const float* below, int u) {
  return w[0] * above[u] + w[1] * above[u + 1] + w[2] * below[u] + w[3] * below[u + 1];
}

// Takes a beam one slice on, between two slices whose means of sigma_t and L_e stand for what lies between.
// @param light  of the slice, to which the beam adds its share
void carryBeam(Beam& beam, const CellPlanes& before, const CellPlanes& here, std::array<CellPlane, 3>& light, int width,
               int height) {
  beam.radiance.swap(beam.before);
  std::vector<float> through(static_cast<std::size_t>(width)), share(static_cast<std::size_t>(width));
  for (int v = 0; v < height; ++v) {
    // Offsets of less than one cell and the next one stay within the margin, but for those of exactly one.
    const int above = v + beam.v, below = std::min(above + 1, height);
    const auto& w = beam.weights;
    const float *sigma = here[kExtinction].row(v), *first = before[kExtinction].row(above) + beam.u,
                *second = before[kExtinction].row(below) + beam.u;
    const int last = beam.u > 0 ? width - 1 : width;  // of a beam along the diagonal the outermost cells get nothing
    for (int u = 0; u < last; ++u) {
      const float tau = 0.5f * (sigma[u] + meanOf(w, first, second, u)) * beam.length;
      const float t = std::exp(-tau);
      through[static_cast<std::size_t>(u)] = t;
      share[static_cast<std::size_t>(u)] = tau > 1e-3f ? beam.length * (1 - t) / tau : beam.length * (1 - 0.5f * tau);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const float *glow = here[c].row(v), *glow0 = before[c].row(above) + beam.u,
                  *glow1 = before[c].row(below) + beam.u;
      const float *old0 = beam.before[c].row(above) + beam.u, *old1 = beam.before[c].row(below) + beam.u;
      float *const next = beam.radiance[c].row(v), *const sum = light[c].row(v);
      for (int u = 0; u < last; ++u) {
        const std::size_t i = static_cast<std::size_t>(u);
        next[u] = meanOf(w, old0, old1, u) * through[i] + 0.5f * (glow[u] + meanOf(w, glow0, glow1, u)) * share[i];
        sum[u] += beam.weight * next[u];
      }
      for (int u = last; u < width; ++u) next[u] = 0;
    }
  }
}

}  // namespace

void GlowLight::update(const Bricks& volume, const LightMedium& medium) {
  if (!medium.emitted) {
    *this = {};
    return;
  }
  Key key{medium.transfer, *medium.emitted, medium.planes};
  if (key_ == key) return;
  *this = {};
  chooseCells(volume.domain);
  fill(volume, key);
  if (std::ranges::any_of(emitted_, [](const glm::vec3& each) { return each != glm::vec3(0); }))
    propagate(volume.indexToWorld);
  extinction_ = {};
  emitted_ = {};
  for (const glm::vec3& each : light_) most_ = glm::max(most_, each);
  key_ = std::move(key);
}

// Cells are as small as there may be many.
void GlowLight::chooseCells(const IndexBox& domain) {
  if (domain.empty()) return;
  for (cell_ = 1;; cell_ *= 2) {
    // They begin at multiples of their edge, so that those of bricks are whole where they can be.
    const auto cellOf = [&](int voxel) { return voxel >= 0 ? voxel / cell_ : -((cell_ - 1 - voxel) / cell_); };
    for (int axis = 0; axis < 3; ++axis) {
      const int first = cellOf(domain.min[axis]);
      origin_[axis] = first * cell_;
      size_[axis] = cellOf(domain.max[axis]) - first + 1;
    }
    if (double{1} * size_.x * size_.y * size_.z <= kMostCells) break;
  }
  extinction_.assign(placeOf({0, 0, size_.z}), 0.0f);
  emitted_.assign(extinction_.size(), glm::vec3(0));
}

void GlowLight::fill(const Bricks& volume, const Key& key) {
  if (extinction_.empty()) return;
  const SampledFunction emitted(key.emitted);
  const std::optional<SampledFunction> table =
      key.transfer.is2d() ? std::nullopt : std::optional<SampledFunction>(key.transfer);
  const float share = 1 / (static_cast<float>(cell_) * static_cast<float>(cell_) * static_cast<float>(cell_));
  const glm::ivec3 edge = volume.layout.edge(), end = origin_ + size_ * cell_;
  const int apron = volume.layout.apron;
  // Cells of the background, from which bricks differ.
  const float outside = static_cast<float>(key.transfer(volume.background).sigma_t);
  std::ranges::fill(extinction_, outside);
  struct Scratch {
    std::vector<float> values, gradients, glow;
  };
  tbb::enumerable_thread_specific<Scratch> scratches;
  // Sums over each brick, which are added in one order afterwards, so that the same scene has the same light.
  struct Sums {
    glm::ivec3 first{0}, count{0};
    std::vector<glm::vec4> cells;
  };
  std::vector<Sums> sums(volume.bricks.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, volume.bricks.size(), 1), [&](const auto& range) {
    Scratch& scratch = scratches.local();
    scratch.values.resize(volume.layout.voxels());
    scratch.glow.resize(volume.layout.voxels());
    if (!table) scratch.gradients.resize(volume.layout.voxels());
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const Brick& brick = volume.bricks[i];
      const bool glows = !key.emitted.isTransparent(brick.emission);
      if (!glows && outside == 0 && key.transfer.isTransparent(brick.value, brick.gradient)) continue;
      volume.read(brick.origin, scratch.values, scratch.gradients);
      if (glows) volume.readEmission(brick.origin, scratch.glow);
      const glm::ivec3 low = glm::max(brick.origin, origin_),
                       high = glm::min(brick.origin + volume.layout.interior, end);  // beyond the last voxel
      if (low.x >= high.x || low.y >= high.y || low.z >= high.z) continue;
      const glm::ivec3 first = (low - origin_) / cell_, count = (high - 1 - origin_) / cell_ - first + 1;
      std::vector<glm::vec4> cells(static_cast<std::size_t>(count.x * count.y * count.z), glm::vec4(0));
      for (int z = low.z; z < high.z; ++z)
        for (int y = low.y; y < high.y; ++y)
          for (int x = low.x; x < high.x; ++x) {
            const glm::ivec3 voxel(x, y, z);
            const bool within = std::ranges::all_of(key.planes, [&](const glm::dvec4& plane) {
              return glm::dot(glm::dvec3(plane), glm::dvec3(voxel)) + plane.w >= 0;
            });
            const glm::ivec3 p = voxel - brick.origin + apron, c = (voxel - origin_) / cell_ - first;
            const std::size_t at = static_cast<std::size_t>((p.z * edge.y + p.y) * edge.x + p.x);
            glm::vec4& sum = cells[static_cast<std::size_t>((c.z * count.y + c.y) * count.x + c.x)];
            sum.w -= outside;
            if (!within) continue;
            if (glows) sum += glm::vec4(glm::vec3(emitted(scratch.glow[at])), 0);
            sum.w += table ? (*table)(scratch.values[at]).w
                           : static_cast<float>(key.transfer(scratch.values[at], scratch.gradients[at]).sigma_t);
          }
      sums[i] = {first, count, std::move(cells)};
    }
  });
  for (const Sums& brick : sums) {
    std::size_t from = 0;
    for (int z = 0; z < brick.count.z; ++z)
      for (int y = 0; y < brick.count.y; ++y)
        for (int x = 0; x < brick.count.x; ++x, ++from) {
          const std::size_t place = placeOf(brick.first + glm::ivec3(x, y, z));
          extinction_[place] = std::max(extinction_[place] + share * brick.cells[from].w, 0.0f);
          emitted_[place] += share * glm::vec3(brick.cells[from]);
        }
  }
}

void GlowLight::propagate(const glm::dmat4& indexToWorld) {
  std::vector<LightDirection> directions;
  for (const auto& [direction, weight] : sphereDirections(kDirections))
    directions.push_back({direction, glm::dvec3(weight)});
  const std::vector<SweepSide> sides = sweepSides(directions, wholeLight(directions), indexToWorld);
  std::vector<std::vector<glm::vec3>> lights(sides.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sides.size(), 1), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const SweepSide& side = sides[i];
      lights[i].assign(extinction_.size(), glm::vec3(0));
      const SweepAxes axes = kSweepAxes[side.axis];
      const int width = size_[axes.u], height = size_[axes.v], slices = size_[axes.n];
      std::vector<Beam> beams;
      for (const SweptDirection& direction : side.directions) beams.push_back(beamOf(direction, cell_, width, height));
      const CellPlane dark(width, height);
      CellPlanes before{dark, dark, dark, dark}, here = before;
      const auto cellAt = [&](int u, int v, int n) {
        glm::ivec3 cell(0);
        cell[axes.u] = u;
        cell[axes.v] = v;
        cell[axes.n] = n;
        return placeOf(cell);
      };
      // From the side that the light of these directions comes from.
      for (int step = 0; step < slices; ++step) {
        const int n = side.sign > 0 ? slices - 1 - step : step;
        for (int v = 0; v < height; ++v)
          for (int u = 0; u < width; ++u) {
            const std::size_t place = cellAt(u, v, n);
            for (std::size_t c = 0; c < 3; ++c) here[c].row(v)[u] = emitted_[place][static_cast<glm::length_t>(c)];
            here[kExtinction].row(v)[u] = extinction_[place];
          }
        std::array<CellPlane, 3> light{dark, dark, dark};
        for (Beam& beam : beams) carryBeam(beam, before, here, light, width, height);
        for (int v = 0; v < height; ++v)
          for (int u = 0; u < width; ++u)
            lights[i][cellAt(u, v, n)] = glm::vec3(light[0].row(v)[u], light[1].row(v)[u], light[2].row(v)[u]);
        here.swap(before);
      }
    }
  });
  light_.assign(extinction_.size(), glm::vec3(0));
  for (const std::vector<glm::vec3>& side : lights)
    for (std::size_t place = 0; place < light_.size(); ++place) light_[place] += side[place];
}

glm::vec3 GlowLight::at(const glm::vec3& place) const {
  if (light_.empty()) return glm::vec3(0);
  // In cells, whose centres lie at whole numbers; beyond the outermost ones the light goes on.
  const glm::vec3 centre = (place - glm::vec3(origin_) + 0.5f) / static_cast<float>(cell_) - 0.5f;
  const glm::vec3 p = glm::clamp(centre, glm::vec3(0), glm::vec3(size_ - 1));
  const glm::ivec3 low = glm::min(glm::ivec3(p), glm::max(size_ - 2, 0)), high = glm::min(low + 1, size_ - 1);
  const glm::vec3 f = p - glm::vec3(low);
  glm::vec3 sum(0);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 cell((corner & 1) ? high.x : low.x, (corner & 2) ? high.y : low.y, (corner & 4) ? high.z : low.z);
    const float weight =
        ((corner & 1) ? f.x : 1 - f.x) * ((corner & 2) ? f.y : 1 - f.y) * ((corner & 4) ? f.z : 1 - f.z);
    sum += weight * light_[placeOf(cell)];
  }
  return sum;
}

}  // namespace umbrick
