// SPDX-License-Identifier: Apache-2.0
#include "shade/light_plan.h"

#include <algorithm>
#include <utility>

namespace umbrick {
namespace {

// The eye reads a texel together with its neighbours, so a light window needs a border of so many texels.
constexpr double kBorder = 2;
// Up to 32 slices are lit in one batch; this, together with their bytes, bounds the depth of the texture arrays
// on the lattice.
constexpr int kMostSlices = 32;
constexpr double kMostSliceBytes = 64 << 20;

// Returns the area of the largest light window of a run, texels.
double largestArea(const LightRun& run) {
  double largest = 0;
  run.forEachWindow([&](const LightWindow& window) { largest = std::max(largest, window.area()); });
  return largest;
}

}  // namespace

LightPlanner::LightPlanner(const LightExtents& extents, const LightPaths& paths)
    : extents_(extents), view_(extents, paths.view) {
  for (const LightSlope& light : paths.lights) lights_.emplace_back(extents, light);
}

LightPlanner::PathPlan::PathPlan(const LightExtents& extents, const LightSlope& light) {
  const std::size_t count = extents.depths.size();
  readFrom.resize(count);
  touchedUntil.resize(count);
  const auto shift = [&](std::size_t i) { return extents.depths[i] / extents.texel * light.slope; };
  Rectangle touched, read;
  for (std::size_t i = 0; i < count; ++i) {
    if (!extents.occluding[i].empty()) touched.include(extents.occluding[i].moved(shift(i)));
    touchedUntil[i] = touched.grown(kBorder);
  }
  for (std::size_t i = count; i-- > 0;) {
    if (!extents.seen[i].empty()) read.include(extents.seen[i].moved(shift(i)));
    readFrom[i] = read.grown(kBorder);
  }
}

LightWindow LightPlanner::PathPlan::window(std::int64_t first, std::int64_t last) const {
  const Rectangle live = readFrom[static_cast<std::size_t>(first)].within(touchedUntil[static_cast<std::size_t>(last)]);
  if (live.empty()) return {};
  const glm::vec<2, std::int64_t> low(glm::floor(live.min)), high(glm::ceil(live.max));
  // The light windows of runs across a wide gap may exceed the range of int: these are too large for a run anyway.
  return {low, glm::ivec2(glm::min(high - low, glm::vec<2, std::int64_t>(1 << 30)))};
}

LightRun LightPlanner::windowsOf(std::int64_t first, std::int64_t last) const {
  LightRun run;
  run.view = view_.window(first, last);
  for (const PathPlan& light : lights_) run.lights.push_back(light.window(first, last));
  return run;
}

std::vector<LightRun> LightPlanner::runs(std::int64_t first, std::int64_t last, int longest, double most) const {
  std::vector<LightRun> runs;
  LightRun run;
  for (std::int64_t i = first; i < last; ++i) {
    if (extents_.holdsNothing(static_cast<std::size_t>(i))) continue;
    LightRun longer;  // the run with this slice, too
    bool fits = !run.slices.empty() && run.slices.size() < static_cast<std::size_t>(longest);
    if (fits) {
      longer = windowsOf(run.slices.front(), i);
      fits = largestArea(longer) <= most;
    }
    if (!fits) {
      if (!run.slices.empty()) runs.push_back(std::move(run));
      run = {};
      longer = windowsOf(i, i);
    }
    longer.slices = std::move(run.slices);
    run = std::move(longer);
    run.slices.push_back(i);
  }
  if (!run.slices.empty()) runs.push_back(std::move(run));
  return runs;
}

std::span<const LightRun> LightRuns::within(std::int64_t first, std::int64_t last) const {
  const auto firstSlice = [](const LightRun& run) { return run.slices.front(); };
  const auto begin = std::ranges::lower_bound(runs, first, {}, firstSlice);
  return {begin, std::ranges::lower_bound(begin, runs.end(), last, {}, firstSlice)};
}

LightRuns planLightRuns(const LightPlanner& planner, std::span<const SweepRun> sweeps, double bytesPerSlice) {
  LightRuns plan;
  // Long runs save the driver work, so their windows may be half as large again as those of single slices.
  double area = 1;
  for (const SweepRun& sweep : sweeps)
    for (const LightRun& run : planner.runs(sweep.first, sweep.last, 1, 0)) area = std::max(area, largestArea(run));
  plan.slicesTogether =
      static_cast<int>(std::clamp(kMostSliceBytes / bytesPerSlice, 1.0, static_cast<double>(kMostSlices)));
  for (const SweepRun& sweep : sweeps)
    for (LightRun& run : planner.runs(sweep.first, sweep.last, plan.slicesTogether, 1.5 * area)) {
      run.forEachWindow([&](const LightWindow& window) { plan.windowSize = glm::max(plan.windowSize, window.size); });
      plan.runs.push_back(std::move(run));
    }
  return plan;
}

}  // namespace umbrick
