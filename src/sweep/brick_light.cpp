// SPDX-License-Identifier: Apache-2.0
#include "sweep/brick_light.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/extremes.h"
#include "umbrick/core/stopwatch.h"

namespace umbrick {
namespace {

// Light is 0 at voxels without medium next to them. Rays read light half a slice away from the medium, too, so that it
// goes on for one more voxel along each axis: as the mean of the neighbours that have any. `scratch` is of the same
// size.
void spread(std::vector<float>& light, std::vector<float>& scratch, const glm::ivec3& edge) {
  const auto [least, most] = leastAndMost(light);
  if (least > 0 || most <= 0) return;
  const std::ptrdiff_t strides[3]{1, edge.x, static_cast<std::ptrdiff_t>(edge.x) * edge.y};
  const auto filled = [](float here, float before, float behind) {
    const float beside = before > 0 && behind > 0 ? 0.5f * (before + behind) : before + behind;
    return here > 0 ? here : beside;
  };
  for (int axis = 0; axis < 3; ++axis) {
    // Numbers that stand together: a row along x, or all of a row or slice that has neighbours along the axis.
    const std::ptrdiff_t stride = strides[axis], together = axis == 0 ? 1 : stride, block = stride * edge[axis];
    const float* const from = light.data();
    float* const to = scratch.data();
    for (std::ptrdiff_t first = 0; first < static_cast<std::ptrdiff_t>(light.size()); first += block) {
      const std::ptrdiff_t last = first + block - together;
      for (std::ptrdiff_t i = first; i < first + together; ++i) to[i] = filled(from[i], 0, from[i + stride]);
      for (std::ptrdiff_t i = first + together; i < last; ++i)
        to[i] = filled(from[i], from[i - stride], from[i + stride]);
      for (std::ptrdiff_t i = last; i < last + together; ++i) to[i] = filled(from[i], from[i - stride], 0);
    }
    light.swap(scratch);
  }
}

}  // namespace

void BrickLight::update(LightMedium medium, const ResolvedScene& scene, std::span<const glm::dvec4> planes,
                        const BrickLayout& layout) {
  const Stopwatch watch;
  for (const glm::dvec4& plane : planes)
    if (cutsMedium(plane, medium.cells, layout.interior)) medium.planes.push_back(plane);
  const std::uint64_t most = std::max<std::uint64_t>(scene.bricks.budgetMiB << 20, std::uint64_t{2} << 30);
  // Where anything fails on the way, light is stored again the next time.
  const std::uint64_t stored = std::exchange(generation_, kNoGeneration);
  if (!light_.update(medium, most)) generation_ = stored;
  ms_ = watch.elapsedMs();
}

void BrickLight::addTo(RenderStats& stats) const {
  const LightStats& light = light_.stats();
  stats.lightMs = ms_;
  stats.directions = light.directions;
  stats.windowUpdates = light.updates;
  stats.lightSpacing = light.spacing;
  stats.lightSpacingError = light.spacingError;
}

void BrickLight::store(BrickVoxels& voxels) {
  if (generation_ == voxels.generation()) return;
  const Stopwatch watch;
  const std::size_t count = voxels.volume().layout.voxels(), channels = static_cast<std::size_t>(light_.channels());
  const auto bricks = voxels.bricks();
  const tbb::blocked_range<std::size_t> all(0, bricks.size(), 1);
  tbb::enumerable_thread_specific<std::vector<float>> scratches;
  const auto read = [&](std::size_t i) -> std::vector<float>& {
    std::vector<float>& light = scratches.local();
    light.resize(count * channels);
    light_.read(bricks[i]->origin, light);
    return light;
  };
  // Beyond planes that cut the medium light is more than all that arrives, so that the largest number is looked for.
  const float largest = tbb::parallel_reduce(
      all, 1.0f,
      [&](const auto& range, float most) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) most = std::max(most, leastAndMost(read(i)).second);
        return most;
      },
      [](float a, float b) { return std::max(a, b); });
  unit_ = largest / 65535;
  tbb::parallel_for(all, [&](const auto& range) {
    std::vector<float> plane(count), scratch(count);
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const std::vector<float>& light = read(i);
      VoxelBrick& brick = voxels.brick(i);
      brick.light = std::make_unique_for_overwrite<std::uint16_t[]>(count * channels + BrickVoxels::kPadding);
      for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t v = 0; v < count; ++v) plane[v] = std::max(light[v * channels + c], 0.0f);
        spread(plane, scratch, voxels.volume().layout.edge());
        for (std::size_t v = 0; v < count; ++v)
          brick.light[c * count + v] = static_cast<std::uint16_t>(std::min(plane[v] / unit_ + 0.5f, 65535.0f));
      }
    }
  });
  generation_ = voxels.generation();
  ms_ += watch.elapsedMs();
}

}  // namespace umbrick
