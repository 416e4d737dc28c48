// SPDX-License-Identifier: Apache-2.0
#include "umbrick/light/light_volume.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "light/extinction_table.h"
#include "light/light_sweep.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"

namespace umbrick {
namespace {

// So many directions share a sweep: what they read and what they add is brought to the sweep's planes once for all.
constexpr std::size_t kDirectionsTogether = 8;

bool comesBefore(const glm::ivec3& a, const glm::ivec3& b) {
  return std::tuple(a.z, a.y, a.x) < std::tuple(b.z, b.y, b.x);
}

std::size_t voxelsOf(const glm::ivec3& edge) {
  return static_cast<std::size_t>(edge.x) * static_cast<std::size_t>(edge.y) * static_cast<std::size_t>(edge.z);
}

SweptDirection sweptDirection(const LightDirection& light, const glm::dmat3& toIndex) {
  const glm::dvec3 direction = toIndex * light.direction;  // per world unit
  SweptDirection swept;
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(direction[axis]) > std::abs(direction[swept.axis])) swept.axis = axis;
  const SweepAxes axes = kSweepAxes[swept.axis];
  const double along = std::abs(direction[axes.n]);
  swept.sign = direction[axes.n] > 0 ? 1 : -1;
  swept.u = -direction[axes.u] / along;
  swept.v = -direction[axes.v] / along;
  swept.length = 1 / along;
  return swept;
}

}  // namespace

bool cutsMedium(const glm::dvec4& plane, std::span<const glm::ivec3> cells, const glm::ivec3& interior) {
  return std::ranges::any_of(cells, [&](const glm::ivec3& cell) {
    double least = plane.w;
    for (int axis = 0; axis < 3; ++axis)
      least += std::min(plane[axis] * (cell[axis] - 2), plane[axis] * (cell[axis] + interior[axis] + 1));
    return least < 0;
  });
}

class LightVolume::Implementation {
 public:
  explicit Implementation(const Bricks& volume) : volume_(volume) {}

  bool update(const LightMedium& medium, std::uint64_t mostBytes) {
    if (medium_ && *medium_ == medium) return false;
    const Stopwatch watch;
    medium_.reset();  // until all is computed
    stats_ = {};
    cells_ = medium.cells;
    std::sort(cells_.begin(), cells_.end(), comesBefore);
    const std::vector<std::vector<SweptDirection>> sweeps = sortDirections(medium.directions);
    checkMemory(mostBytes);
    light_.assign(cells_.size() * volume_.layout.voxels() * static_cast<std::size_t>(channels()), 0);
    if (!cells_.empty()) {
      const ExtinctionTable extinction(medium.transfer);
      readValues(medium.transfer, extinction);
      for (int axis = 0; axis < 3; ++axis) sweepAxis(axis, sweeps, medium.planes, extinction);
      values_ = sweptValues_ = {};
      sweptLight_ = {};
      lit_ = {};
    }
    stats_.directions = static_cast<int>(medium.directions.size());
    stats_.ms = watch.elapsedMs();
    medium_ = medium;
    return true;
  }

  int channels() const { return coloured_ ? 3 : 1; }
  bool coloured() const { return coloured_; }
  const glm::dvec3& whole() const { return whole_; }
  const LightStats& stats() const { return stats_; }

  void read(const glm::ivec3& origin, std::span<float> light) const {
    const glm::ivec3 edge = volume_.layout.edge();
    const auto count = static_cast<std::size_t>(channels());
    if (light.size() != voxelsOf(edge) * count)
      throw InvalidArgument("light: " + std::to_string(light.size()) + " numbers to fill, must be " +
                            std::to_string(voxelsOf(edge) * count));
    const auto found = std::lower_bound(cells_.begin(), cells_.end(), origin, comesBefore);
    if (found == cells_.end() || *found != origin)
      throw InvalidArgument("light: there is none for the brick at (" + std::to_string(origin.x) + ", " +
                            std::to_string(origin.y) + ", " + std::to_string(origin.z) + ")");
    const auto cell = static_cast<std::size_t>(found - cells_.begin());
    const std::size_t voxels = voxelsOf(edge);
    for (std::size_t c = 0; c < count; ++c) {
      const std::int32_t* from = light_.data() + (cell * count + c) * voxels;
      for (std::size_t i = 0; i < voxels; ++i) light[i * count + c] = static_cast<float>(from[i]) * (1 / kWholeLight);
    }
  }

 private:
  // Sorts directions by axis and sign, in groups that share a sweep.
  std::vector<std::vector<SweptDirection>> sortDirections(const std::vector<LightDirection>& directions) {
    const glm::dmat3 toIndex = glm::inverse(glm::dmat3(volume_.indexToWorld));
    whole_ = glm::dvec3(0);
    for (const LightDirection& light : directions) whole_ += light.radiance;
    const double power = whole_.r + whole_.g + whole_.b;
    coloured_ = false;
    std::map<std::pair<int, int>, std::vector<SweptDirection>> byAxis;
    for (const LightDirection& light : directions) {
      SweptDirection swept = sweptDirection(light, toIndex);
      const double share = power > 0 ? (light.radiance.r + light.radiance.g + light.radiance.b) / power : 0;
      const glm::dvec3 tint = glm::abs(light.radiance - share * whole_);
      coloured_ = coloured_ || std::max({tint.r, tint.g, tint.b}) > 1e-9 * power;
      for (int c = 0; c < 3; ++c)
        swept.weight[static_cast<std::size_t>(c)] =
            static_cast<float>(whole_[c] > 0 ? light.radiance[c] / whole_[c] : 0);
      byAxis[{swept.axis, swept.sign}].push_back(swept);
    }
    std::vector<std::vector<SweptDirection>> groups;
    for (const auto& [key, list] : byAxis) {
      const std::size_t count = (list.size() + kDirectionsTogether - 1) / kDirectionsTogether;
      for (std::size_t i = 0; i < count; ++i)
        groups.emplace_back(list.begin() + static_cast<std::ptrdiff_t>(list.size() * i / count),
                            list.begin() + static_cast<std::ptrdiff_t>(list.size() * (i + 1) / count));
    }
    stats_.sweeps = static_cast<int>(byAxis.size());
    return groups;
  }

  void checkMemory(std::uint64_t most) {
    // Light and values are held once as they stay, and once in the order of a sweep.
    stats_.bytes = cells_.size() * volume_.layout.voxels() * 2 *
                   (sizeof(float) + sizeof(std::int32_t) * static_cast<std::uint64_t>(channels()));
    if (stats_.bytes > most)
      throw InvalidArgument("light-volume: the light of " + std::to_string(cells_.size()) + " visible bricks takes " +
                            std::to_string((stats_.bytes >> 20) + 1) + " MiB, more than " + std::to_string(most >> 20) +
                            " MiB; ordinates need less");
  }

  void readValues(const TransferFunction& transfer, const ExtinctionTable& extinction) {
    const std::size_t voxels = volume_.layout.voxels();
    values_.resize(cells_.size() * voxels);
    lit_.assign(cells_.size(), LitBlocks(volume_.layout.interior, volume_.layout.apron));
    tbb::enumerable_thread_specific<std::vector<float>> scratches;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cells_.size(), 1), [&](const auto& range) {
      std::vector<float>& gradients = scratches.local();
      if (transfer.is2d()) gradients.resize(voxels);
      for (std::size_t cell = range.begin(); cell != range.end(); ++cell) {
        const std::span<float> values = std::span(values_).subspan(cell * voxels, voxels);
        volume_.read(cells_[cell], values, gradients);
        for (std::size_t i = 0; i < voxels; ++i)
          values[i] = extinction.stepsOf(values[i], gradients.empty() ? 0.0f : gradients[i]);
        findLit(values.data(), extinction, lit_[cell]);
      }
    });
  }

  // Marks the blocks of a brick that have medium between any of their voxels.
  void findLit(const float* values, const ExtinctionTable& extinction, LitBlocks& lit) const {
    const glm::ivec3 edge = volume_.layout.edge();
    const int apron = volume_.layout.apron;
    std::vector<float> low(static_cast<std::size_t>(edge.x)), high(low);
    std::vector<char> medium(static_cast<std::size_t>(edge.x) - 1);
    for (int z = 0; z + 1 < edge.z; ++z)
      for (int y = 0; y + 1 < edge.y; ++y) {
        const float* a = values + (std::ptrdiff_t(z) * edge.y + y) * edge.x;
        const float *b = a + edge.x, *c = a + std::ptrdiff_t(edge.y) * edge.x, *d = c + edge.x;
        for (int x = 0; x < edge.x; ++x) {
          low[static_cast<std::size_t>(x)] = std::min(std::min(a[x], b[x]), std::min(c[x], d[x]));
          high[static_cast<std::size_t>(x)] = std::max(std::max(a[x], b[x]), std::max(c[x], d[x]));
        }
        for (std::size_t x = 0; x + 1 < low.size(); ++x)
          medium[x] = !extinction.isTransparent(std::min(low[x], low[x + 1]), std::max(high[x], high[x + 1]));
        lit.markRow(medium.data(), y - apron, z - apron);
      }
  }

  void sweepAxis(int axis, const std::vector<std::vector<SweptDirection>>& sweeps,
                 const std::vector<glm::dvec4>& planes, const ExtinctionTable& extinction) {
    std::vector<const std::vector<SweptDirection>*> mine;
    for (const auto& group : sweeps)
      if (group.front().axis == axis) mine.push_back(&group);
    if (mine.empty()) return;
    const SweepAxes axes = kSweepAxes[axis];
    const std::size_t held = volume_.layout.voxels();
    SweptBricks bricks{.lattice = SweepLattice(axis, cells_, volume_.layout),
                       .lit = &lit_,
                       .values = values_.data(),
                       .light = light_.data(),
                       .channels = channels(),
                       .extinction = &extinction,
                       .planes = {},
                       .busy = {}};
    bricks.busy =
        std::vector<std::mutex>(static_cast<std::size_t>(bricks.lattice.lastSlice() - bricks.lattice.firstSlice() + 1));
    for (const glm::dvec4& plane : planes)
      bricks.planes.emplace_back(plane[axes.u], plane[axes.v], plane[axes.n], plane.w);
    // Along z voxels are in the order of the sweep as they are.
    const bool asStored = axes.n == 2;
    if (!asStored) {
      sweptValues_.resize(values_.size());
      sweptLight_.assign(light_.size(), 0);
      bricks.values = sweptValues_.data();
      bricks.light = sweptLight_.data();
      tbb::parallel_for(std::size_t{0}, cells_.size(), [&](std::size_t cell) {
        permuteBlock(axes, volume_.layout.edge(), sweptValues_.data() + cell * held, values_.data() + cell * held,
                     [](float& swept, float& plain) { swept = plain; });
      });
    }
    std::atomic<std::uint64_t> updates{0};
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mine.size(), 1), [&](const auto& range) {
      for (std::size_t i = range.begin(); i != range.end(); ++i) updates += sweepLight(bricks, *mine[i]);
    });
    stats_.updates += updates;
    if (asStored) return;
    tbb::parallel_for(std::size_t{0}, cells_.size() * static_cast<std::size_t>(channels()), [&](std::size_t block) {
      permuteBlock(axes, volume_.layout.edge(), sweptLight_.data() + block * held, light_.data() + block * held,
                   [](std::int32_t& swept, std::int32_t& plain) { plain += swept; });
    });
  }

  const Bricks& volume_;
  std::optional<LightMedium> medium_;
  std::vector<glm::ivec3> cells_;
  std::vector<LitBlocks> lit_;      // by cell
  std::vector<float> values_;       // of each cell with its apron, x fastest, in steps of the table
  std::vector<float> sweptValues_;  // the same in the order of a sweep
  std::vector<std::int32_t> sweptLight_;
  std::vector<std::int32_t> light_;  // of each cell with its apron, channel by channel
  glm::dvec3 whole_{0};
  bool coloured_ = false;
  LightStats stats_;
};

LightVolume::LightVolume(const Bricks& volume) : implementation_(std::make_unique<Implementation>(volume)) {}
LightVolume::~LightVolume() = default;
bool LightVolume::update(const LightMedium& medium, std::uint64_t mostBytes) {
  return implementation_->update(medium, mostBytes);
}
bool LightVolume::coloured() const { return implementation_->coloured(); }
glm::dvec3 LightVolume::whole() const { return implementation_->whole(); }
const LightStats& LightVolume::stats() const { return implementation_->stats(); }
void LightVolume::read(const glm::ivec3& origin, std::span<float> light) const { implementation_->read(origin, light); }

}  // namespace umbrick
