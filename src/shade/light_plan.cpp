#include "shade/light_plan.h"

#include <algorithm>
#include <cmath>

namespace umbrick {
namespace {
// A texel is read with its neighbours.
constexpr double kBorder = 2;
}  // namespace

void Rectangle::include(const Rectangle& other) {
  if (other.empty()) return;
  min = glm::min(min, other.min);
  max = glm::max(max, other.max);
}
Rectangle Rectangle::within(const Rectangle& other) const {
  return {glm::max(min, other.min), glm::min(max, other.max)};
}
Rectangle Rectangle::grown(double by) const { return empty() ? *this : Rectangle{min - by, max + by}; }

LightSlope lightSlope(const glm::dvec3& towards) {
  const double along = std::max(towards.z, 1e-6);
  return {glm::dvec2(towards) / along, 1 / along};
}

std::vector<Rectangle> neededRegions(const LightExtents& extents, std::span<const LightSlope> slopes) {
  const std::size_t count = extents.depths.size();
  std::vector<Rectangle> needed(count);
  for (const LightSlope& light : slopes) {
    Rectangle paths;
    for (std::size_t i = count; i-- > 0;) {
      const glm::dvec2 shift = extents.depths[i] / extents.texel * light.slope;
      if (!extents.seen[i].empty()) paths.include(extents.seen[i].moved(shift));
      if (!paths.empty()) needed[i].include(paths.moved(-shift));
    }
  }
  return needed;
}

LightPlanner::LightPlanner(const LightExtents& extents, std::span<const LightSlope> slopes)
    : extents_(extents), slopes_(slopes.begin(), slopes.end()) {
  const std::size_t count = extents.depths.size();
  readFrom_.resize(count * slopes_.size());
  touchedUntil_.resize(count * slopes_.size());
  for (std::size_t k = 0; k < slopes_.size(); ++k) {
    const auto shift = [&](std::size_t i) { return extents.depths[i] / extents.texel * slopes_[k].slope; };
    Rectangle touched, read;
    for (std::size_t i = 0; i < count; ++i) {
      if (!extents.occluding[i].empty()) touched.include(extents.occluding[i].moved(shift(i)));
      touchedUntil_[k * count + i] = touched.grown(kBorder);
    }
    for (std::size_t i = count; i-- > 0;) {
      if (!extents.seen[i].empty()) read.include(extents.seen[i].moved(shift(i)));
      readFrom_[k * count + i] = read.grown(kBorder);
    }
  }
}

LightWindow LightPlanner::window(std::size_t direction, std::int64_t first, std::int64_t last) const {
  const Rectangle live = readFrom_[at(direction, first)].within(touchedUntil_[at(direction, last)]);
  if (live.empty()) return {};
  const glm::vec<2, std::int64_t> low(glm::floor(live.min)), high(glm::ceil(live.max));
  // Those of runs across a wide gap may be larger than numbers: too large for a run anyway.
  return {low, glm::ivec2(glm::min(high - low, glm::vec<2, std::int64_t>(1 << 30)))};
}

std::vector<LightRun> LightPlanner::runs(std::int64_t first, std::int64_t last, int longest, double most) const {
  std::vector<LightRun> runs;
  LightRun run;
  const auto windows = [&](std::int64_t from, std::int64_t to, std::vector<LightWindow>& out) {
    double largest = 0;
    out.clear();
    for (std::size_t k = 0; k < slopes_.size(); ++k) {
      out.push_back(window(k, from, to));
      largest = std::max(largest, static_cast<double>(out.back().size.x) * out.back().size.y);
    }
    return largest;
  };
  std::vector<LightWindow> candidate;
  for (std::int64_t i = first; i < last; ++i) {
    const auto index = static_cast<std::size_t>(i);
    if (extents_.seen[index].empty() && extents_.occluding[index].empty()) continue;
    if (!run.slices.empty()) {
      const bool full = run.slices.size() >= static_cast<std::size_t>(longest);
      if (full || windows(run.slices.front(), i, candidate) > most) {
        runs.push_back(std::move(run));
        run = {};
      }
    }
    if (run.slices.empty()) windows(i, i, candidate);
    run.slices.push_back(i);
    run.windows = candidate;
  }
  if (!run.slices.empty()) runs.push_back(std::move(run));
  return runs;
}

std::vector<Rectangle> polygonExtents(const ProxySlices& slices, const IndexView& view, const glm::dvec2& centre,
                                      double texel) {
  std::vector<Rectangle> extents(static_cast<std::size_t>(slices.count()));
  for (std::int64_t i = 0; i < slices.count(); ++i)
    forEachPolygon(slices, i, view, centre, texel,
                   [&](const Rectangle& polygon) { extents[static_cast<std::size_t>(i)].include(polygon); });
  return extents;
}

}  // namespace umbrick
