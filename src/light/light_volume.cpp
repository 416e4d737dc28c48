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
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "core/extremes.h"
#include "light/glow_light.h"
#include "light/light_edit.h"
#include "light/light_sweep.h"
#include "light/mesh_shadow.h"
#include "light/stored_light.h"
#include "umbrick/core/error.h"
#include "umbrick/core/stopwatch.h"
#include "umbrick/light/extinction_table.h"
#include "umbrick/light/light_paths.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {

// So many directions share a sweep: what they read and what they add is brought to the sweep's planes once for all.
constexpr std::size_t kDirectionsTogether = 16;

// An edit that takes more than this share of the work of a fresh sweep is none. Bricks are read for both mediums, so
// that of mediums little more than half of the work costs as much time as all.
constexpr double kMostMediumCost = 0.5, kMostLightCost = 0.8;
// Each edit may round light by half a step. After so many all is swept again.
constexpr int kMostEdits = 8;

/// Directions as sweeps take them.
struct SortedLight {
  std::vector<SweepTask> tasks;
  int sweeps = 0;  // pairs of axis and sign
};
SortedLight sortLight(const std::vector<LightDirection>& directions, const glm::dvec3& whole,
                      const glm::dmat4& indexToWorld) {
  const std::vector<SweepSide> sides = sweepSides(directions, whole, indexToWorld);
  SortedLight sorted;
  sorted.sweeps = static_cast<int>(sides.size());
  for (const SweepSide& side : sides) {
    const std::vector<SweptDirection>& list = side.directions;
    const std::size_t count = (list.size() + kDirectionsTogether - 1) / kDirectionsTogether;
    for (std::size_t i = 0; i < count; ++i)
      sorted.tasks.emplace_back().directions.assign(
          list.begin() + static_cast<std::ptrdiff_t>(list.size() * i / count),
          list.begin() + static_cast<std::ptrdiff_t>(list.size() * (i + 1) / count));
  }
  return sorted;
}

// Tells whether there is a surface between voxels of these values. A voxel is inside of one where its value is larger.
bool crosses(const std::vector<LightSurface>& surfaces, float low, float high) {
  return std::ranges::any_of(surfaces, [&](const LightSurface& one) { return low <= one.value && high > one.value; });
}

// Returns surfaces as paths of light meet them. The values of voxels are not known beside a 2D function.
std::vector<PathSurface> pathSurfaces(const LightMedium& medium, const ExtinctionTable& extinction) {
  std::vector<PathSurface> surfaces;
  if (medium.transfer.is2d()) return surfaces;
  for (const LightSurface& one : medium.surfaces)
    if (one.opacity > 0)
      surfaces.push_back({extinction.stepsOf(static_cast<float>(one.value), 0),
                          std::min(static_cast<float>(-std::log1p(-one.opacity)), 2 * kDarkDepth)});
  return surfaces;
}

}  // namespace

bool showsBackground(const TransferFunction& transfer, const Bricks& volume) {
  return !volume.domain.empty() && !transfer.isTransparent({volume.background, volume.background});
}

LightMedium lightAtSurfaces(const Bricks& volume, const ResolvedScene& scene, std::vector<LightDirection> directions) {
  LightMedium medium{scene.transfer, std::move(directions), {}, {}, scene.occlusion.ordinates.lightSpacing};
  medium.mesh = scene.mesh.shape;
  for (const SceneSurface& surface : scene.surfaces) medium.surfaces.push_back({surface.value, surface.opacity});
  for (const Brick& brick : volume.bricks)
    if (!scene.bricks.culling || !scene.transfer.isTransparent(brick.value, brick.gradient) ||
        crosses(medium.surfaces, brick.value.min, brick.value.max))
      medium.cells.push_back(brick.origin);
  if (showsBackground(scene.transfer, volume))
    for (const Brick& brick : backgroundBricks(volume)) medium.cells.push_back(brick.origin);
  return medium;
}

LightMedium lightInMedium(const ResolvedScene& scene, std::vector<LightDirection> directions,
                          std::vector<glm::ivec3> cells) {
  LightMedium medium{
      scene.transfer, std::move(directions), {}, std::move(cells), scene.occlusion.ordinates.lightSpacing};
  medium.mesh = scene.mesh.shape;
  if (!emissionLights(scene)) return medium;
  medium.emitted = scene.emitted;
  for (LightDirection& direction : medium.directions) direction.radiance *= scene.ambient;
  return medium;
}

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
    std::vector<glm::ivec3> cells = medium.cells;
    std::ranges::sort(cells, comesBefore);
    glow_.update(volume_, medium);
    const glm::dvec3 whole = wholeLight(medium.directions) + glm::dvec3(glow_.most());
    const bool coloured = isColoured(medium.directions) || glow_.any();
    // Until all is computed nothing is held.
    const std::optional<LightMedium> before = std::exchange(medium_, std::nullopt);
    const glm::dvec3 wholeBefore = std::exchange(whole_, whole);
    const bool sameChannels = std::exchange(coloured_, coloured) == coloured;
    stats_ = {};
    stats_.spacing = spacingFor(medium.spacing, cells.size(), mostBytes);
    const SortedLight sorted = sortLight(medium.directions, whole_, volume_.indexToWorld);
    stats_.sweeps = sorted.sweeps;
    keepsValues_ = before.has_value();
    stats_.edited = before && sameChannels && stats_.spacing == stored_.spacing() && edits_ < kMostEdits &&
                    !medium.emitted && !before->emitted &&
                    sweepEdit(*before, wholeBefore, medium, sorted, cells, mostBytes);
    if (stats_.edited) {
      ++edits_;
    } else {
      sweepAll(medium, sorted, std::move(cells));
      edits_ = 0;
    }
    stats_.directions = static_cast<int>(medium.directions.size());
    stats_.heldBytes = stored_.bytes() + (kept_ ? kept_->values->size() * sizeof(float) : 0);
    stats_.spacingError = stored_.spacingError();
    stats_.glowCell = glow_.any() ? glow_.cellEdge() : 0;
    stats_.ms = watch.elapsedMs();
    medium_ = medium;
    return true;
  }

  bool coloured() const { return coloured_; }
  const glm::dvec3& whole() const { return whole_; }
  const LightStats& stats() const { return stats_; }
  void read(const glm::ivec3& origin, std::span<float> light) const { stored_.read(origin, light); }

 private:
  int channels() const { return coloured_ ? 3 : 1; }

  // Values and sums, of which light is made that takes less.
  std::uint64_t bytesFor(std::size_t bricks, int spacing) const {
    return bricks * (volume_.layout.voxels() * sizeof(float) + lightLayout(volume_.layout, spacing).places() *
                                                                   sizeof(std::int32_t) *
                                                                   static_cast<std::uint64_t>(channels()));
  }

  int spacingFor(int asked, std::size_t bricks, std::uint64_t most) {
    int spacing = asked == 2 ? 2 : 1;
    if (asked == 0 && bytesFor(bricks, 1) > most) spacing = 2;
    stats_.bytes = bytesFor(bricks, spacing);
    if (stats_.bytes > most) {
      stored_ = {};
      throw InvalidArgument("light-volume: the light of " + std::to_string(bricks) + " visible bricks takes " +
                            std::to_string((stats_.bytes >> 20) + 1) + " MiB" +
                            (spacing == 2 ? " even at every second voxel" : "") + ", more than " +
                            std::to_string(most >> 20) + " MiB; ordinates need less");
    }
    return spacing;
  }

  void sweepAll(const LightMedium& medium, const SortedLight& sorted, std::vector<glm::ivec3> cells) {
    stored_ = {};
    SweptBricks bricks = bricksOf(cells);
    if (!cells.empty()) sweep(bricks, medium, cells, sorted.tasks, 1);
    bricks.values.reset();
    if (glow_.any()) addGlow(bricks);
    stored_.store(bricks, std::move(cells));
  }

  // Sweeps only what has changed. @return whether that is less work
  bool sweepEdit(const LightMedium& before, const glm::dvec3& wholeBefore, const LightMedium& medium,
                 const SortedLight& sorted, const std::vector<glm::ivec3>& cells, std::uint64_t mostBytes) {
    // Between other ends of the function the steps of its table are others, and all values are rounded to others.
    const std::vector<double>&from = before.transfer.values(), &to = medium.transfer.values();
    if (from.front() != to.front() || from.back() != to.back() || before.surfaces != medium.surfaces ||
        before.mesh != medium.mesh)
      return false;
    const std::vector<glm::ivec3> changed = changedCells(before, medium, volume_);
    if (before.directions != medium.directions) {
      if (!changed.empty()) return false;
      const auto edit = editOf(before.directions, wholeBefore, medium.directions, whole_);
      if (!edit ||
          static_cast<double>(edit->change.size()) > kMostLightCost * static_cast<double>(medium.directions.size()))
        return false;
      SweptBricks bricks = bricksOf(edit->change.empty() ? std::vector<glm::ivec3>{} : cells);
      if (!bricks.origins.empty())
        sweep(bricks, medium, cells, sortLight(edit->change, whole_, volume_.indexToWorld).tasks, 1);
      stored_.change(bricks, cells, edit->scale);
      return true;
    }
    std::vector<glm::ivec3> old = before.cells, both;
    std::ranges::sort(old, comesBefore);
    std::ranges::set_union(old, cells, std::back_inserter(both), comesBefore);
    const LightEdit edit = editOf(sorted.tasks, changed, both, volume_.layout, stats_.spacing);
    if (edit.cost > kMostMediumCost || bytesFor(edit.bricks.size(), stats_.spacing) > mostBytes) return false;
    SweptBricks bricks = bricksOf(edit.bricks);
    if (!edit.bricks.empty()) {
      sweep(bricks, before, old, edit.tasks, -1);
      sweep(bricks, medium, cells, edit.tasks, 1);
    }
    stored_.change(bricks, cells, glm::dvec3(1));
    return true;
  }

  SweptBricks bricksOf(const std::vector<glm::ivec3>& origins) const {
    SweptBricks bricks;
    bricks.layout = volume_.layout;
    bricks.light = lightLayout(volume_.layout, stats_.spacing);
    bricks.origins = origins;
    bricks.channels = channels();
    bricks.toIndex = glm::inverse(glm::dmat3(volume_.indexToWorld));
    bricks.sums.assign(origins.size() * bricks.light.places() * static_cast<std::size_t>(channels()), 0);
    return bricks;
  }

  // Adds the light of a medium. @param cells  those of the medium, ascending; other bricks have none
  void sweep(SweptBricks& bricks, const LightMedium& medium, const std::vector<glm::ivec3>& cells,
             std::vector<SweepTask> tasks, float factor) {
    const ExtinctionTable extinction(medium.transfer);
    bricks.extinction = &extinction;
    bricks.planes = medium.planes;
    bricks.surfaces = pathSurfaces(medium, extinction);
    std::optional<IndexTriangles> mesh;
    if (medium.mesh) mesh = trianglesInIndex(*medium.mesh, volume_.indexToWorld);
    bricks.mesh = mesh ? &*mesh : nullptr;
    bricks.busy = std::make_unique<std::mutex[]>(bricks.origins.size());
    takeValues(bricks, medium, cells);
    std::atomic<std::uint64_t> updates{0};
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, tasks.size(), 1),
        [&](const auto& range) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) {
            tasks[i].factor = factor;
            updates += sweepLight(bricks, tasks[i]);
          }
        },
        tbb::simple_partitioner());
    stats_.updates += updates;
    bricks.extinction = nullptr;
    bricks.mesh = nullptr;
  }

  // Reads the values of bricks, or takes those that were read for the last update where the medium is the same, as
  // while the camera or a light moves.
  void takeValues(SweptBricks& bricks, const LightMedium& medium, const std::vector<glm::ivec3>& cells) {
    const bool all = bricks.origins == cells;
    if (all && kept_ && kept_->isOf(medium, cells, stats_.spacing)) {
      bricks.values = kept_->values;
      bricks.lit = kept_->lit;
      return;
    }
    if (all) kept_.reset();
    readValues(bricks, medium, cells);
    if (all && keepsValues_)
      kept_ = {medium.transfer, medium.surfaces, cells, stats_.spacing, bricks.values, bricks.lit};
  }

  // Adds the light of what emits.
  void addGlow(SweptBricks& bricks) const {
    const std::size_t places = bricks.light.places();
    glm::vec3 perLight(0);
    for (int c = 0; c < 3; ++c)
      if (whole_[c] > 0) perLight[c] = static_cast<float>(kWholeLight / whole_[c]);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, bricks.origins.size(), 1), [&](const auto& range) {
      for (std::size_t brick = range.begin(); brick != range.end(); ++brick) {
        std::int32_t* const sums = bricks.sums.data() + brick * places * 3;
        forEachRow(bricks.lit[brick], bricks.light, [&](const glm::ivec3& first, std::size_t place, std::size_t count) {
          glm::vec3 voxel = glm::vec3(bricks.origins[brick] + first * bricks.light.spacing);
          for (std::size_t i = place; i < place + count; ++i, voxel.x += static_cast<float>(bricks.light.spacing)) {
            const glm::vec3 light = glow_.at(voxel) * perLight;
            for (std::size_t c = 0; c < 3; ++c)
              sums[c * places + i] += static_cast<std::int32_t>(std::lround(light[static_cast<glm::length_t>(c)]));
          }
        });
      }
    });
  }

  void readValues(SweptBricks& bricks, const LightMedium& medium, const std::vector<glm::ivec3>& cells) const {
    const std::size_t voxels = volume_.layout.voxels();
    const auto read = std::make_shared<LargeVector<float>>(bricks.origins.size() * voxels);
    bricks.lit.assign(bricks.origins.size(), LitBlocks(bricks.layout, bricks.light));
    tbb::enumerable_thread_specific<std::vector<float>> scratches;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, bricks.origins.size(), 1), [&](const auto& range) {
      std::vector<float>& gradients = scratches.local();
      if (medium.transfer.is2d()) gradients.resize(voxels);
      for (std::size_t brick = range.begin(); brick != range.end(); ++brick) {
        if (!std::ranges::binary_search(cells, bricks.origins[brick], comesBefore)) continue;
        const std::span<float> values = std::span(*read).subspan(brick * voxels, voxels);
        volume_.read(bricks.origins[brick], values, gradients);
        if (!medium.surfaces.empty()) findSurfaces(values, medium.surfaces, bricks.lit[brick]);
        bricks.extinction->toSteps(values, gradients);
        findLit(values.data(), *bricks.extinction, bricks.lit[brick]);
      }
    });
    bricks.values = read;
  }

  // Marks the blocks of a brick that have medium between any of their voxels.
  void findLit(const float* values, const ExtinctionTable& extinction, LitBlocks& lit) const {
    const auto [least, most] = leastAndMost(std::span(values, volume_.layout.voxels()));
    if (extinction.isOpaque(least, most)) return lit.markAll();
    markCells(values, lit, 0, [&](float low, float high) { return !extinction.isTransparent(low, high); });
  }

  // Marks those that surfaces cross.
  void findSurfaces(std::span<const float> values, const std::vector<LightSurface>& surfaces, LitBlocks& lit) const {
    const auto [least, most] = leastAndMost(values);
    if (crosses(surfaces, least, most))
      markCells(values.data(), lit, 1, [&](float low, float high) { return crosses(surfaces, low, high); });
  }

  // Marks the blocks with cells of eight voxels for whose least and largest value isWanted(low, high) holds.
  // @param around  so many voxels farther than light is interpolated around a medium
  template <class IsWanted>
  void markCells(const float* values, LitBlocks& lit, int around, const IsWanted& isWanted) const {
    const glm::ivec3 edge = volume_.layout.edge();
    const int apron = volume_.layout.apron;
    std::vector<float> low(static_cast<std::size_t>(edge.x)), high(low);
    std::vector<char> wanted(static_cast<std::size_t>(edge.x) - 1);
    for (int z = 0; z + 1 < edge.z; ++z)
      for (int y = 0; y + 1 < edge.y; ++y) {
        const float* a = values + (std::ptrdiff_t(z) * edge.y + y) * edge.x;
        const float *b = a + edge.x, *c = a + std::ptrdiff_t(edge.y) * edge.x, *d = c + edge.x;
        for (int x = 0; x < edge.x; ++x) {
          low[static_cast<std::size_t>(x)] = std::min(std::min(a[x], b[x]), std::min(c[x], d[x]));
          high[static_cast<std::size_t>(x)] = std::max(std::max(a[x], b[x]), std::max(c[x], d[x]));
        }
        for (std::size_t x = 0; x + 1 < low.size(); ++x)
          wanted[x] = isWanted(std::min(low[x], low[x + 1]), std::max(high[x], high[x + 1]));
        lit.markRow(wanted.data(), y - apron, z - apron, around);
      }
  }

  /// The values of all bricks of a medium.
  struct KeptValues {
    TransferFunction transfer;
    std::vector<LightSurface> surfaces;
    std::vector<glm::ivec3> cells;  // ascending
    int spacing;
    std::shared_ptr<const LargeVector<float>> values;  // see SweptBricks
    std::vector<LitBlocks> lit;
    bool isOf(const LightMedium& medium, const std::vector<glm::ivec3>& those, int apart) const {
      return spacing == apart && cells == those && surfaces == medium.surfaces && transfer == medium.transfer;
    }
  };

  const Bricks& volume_;
  std::optional<LightMedium> medium_;
  std::optional<KeptValues> kept_;
  bool keepsValues_ = false;  // from the second update on, so that one picture takes no more memory
  StoredLight stored_;
  GlowLight glow_;
  int edits_ = 0;  // since all was swept
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
