// SPDX-License-Identifier: Apache-2.0
#include "light/light_edit.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <iterator>
#include <limits>
#include <map>
#include <tuple>

#include "light/stored_light.h"

namespace umbrick {
namespace {

// A plane changes light, and where it goes on beyond the plane, up to so many voxels around a brick's owned ones.
constexpr int kAroundBrick = 4;

// Following a path costs this share of following it and lighting voxels.
constexpr double kCarryCost = 0.6;

// Least and largest distance of a brick's surroundings from a plane.
Range distances(const glm::dvec4& plane, const glm::ivec3& cell, const glm::ivec3& interior) {
  double low = plane.w, high = plane.w;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = plane[axis] * (cell[axis] - kAroundBrick);
    const double b = plane[axis] * (cell[axis] + interior[axis] - 1 + kAroundBrick);
    low += std::min(a, b);
    high += std::max(a, b);
  }
  return {static_cast<float>(low), static_cast<float>(high)};
}

// Tells whether planes cut a brick alike.
bool sameCut(const std::vector<glm::dvec4>& before, const std::vector<glm::dvec4>& after, const glm::ivec3& cell,
             const glm::ivec3& interior) {
  const auto isOutside = [&](const std::vector<glm::dvec4>& planes) {
    return std::ranges::any_of(planes,
                               [&](const glm::dvec4& plane) { return distances(plane, cell, interior).max < 0; });
  };
  const auto hasNoEffect = [&](const std::vector<glm::dvec4>& planes, const std::vector<glm::dvec4>& others) {
    return std::ranges::all_of(planes, [&](const glm::dvec4& plane) {
      return std::ranges::find(others, plane) != others.end() || distances(plane, cell, interior).min >= 0;
    });
  };
  return (isOutside(before) && isOutside(after)) || (hasNoEffect(before, after) && hasNoEffect(after, before));
}

// The paths of a direction that meet the medium of a brick or are next to its places of light, and their slices.
struct Shadow {
  PlaneWindow paths;
  int low = 0, high = 0;  // slices
};
Shadow shadowOf(const glm::ivec3& cell, const SweptDirection& direction, const BrickLayout& layout, int spacing) {
  const SweepAxes axes = kSweepAxes[direction.axis];
  const int around = std::max(layout.apron, lightLayout(layout, spacing).apron * spacing);
  Shadow shadow;
  shadow.low = cell[axes.n] - around;
  shadow.high = cell[axes.n] + layout.interior[axes.n] - 1 + around;
  const auto range = [&](int axis, double across) {
    // As pathPlace() has it, at both ends; 1 for the places around a path.
    const double a = -direction.sign * static_cast<double>(shadow.low) * across / spacing;
    const double b = -direction.sign * static_cast<double>(shadow.high) * across / spacing;
    const double low = static_cast<double>(cell[axis] - around) / spacing - std::max(a, b) - 1;
    const double high =
        static_cast<double>(cell[axis] + layout.interior[axis] - 1 + around) / spacing - std::min(a, b) + 1;
    return std::pair(static_cast<int>(std::floor(low)), static_cast<int>(std::ceil(high)) + 1);
  };
  std::tie(shadow.paths.u0, shadow.paths.u1) = range(axes.u, direction.u);
  std::tie(shadow.paths.v0, shadow.paths.v1) = range(axes.v, direction.v);
  return shadow;
}

bool overlap(const PlaneWindow& a, const PlaneWindow& b) {
  return a.u0 < b.u1 && b.u0 < a.u1 && a.v0 < b.v1 && b.v0 < a.v1;
}

}  // namespace

bool sameExtinction(const TransferFunction& a, const TransferFunction& b, const Brick& brick) {
  if (a == b) return true;
  if (a.is2d() || b.is2d()) return false;
  const auto same = [&](double value) { return a(value).sigma_t == b(value).sigma_t; };
  const auto inside = [&](double value) { return value > brick.value.min && value < brick.value.max; };
  if (!same(brick.value.min) || !same(brick.value.max)) return false;
  // Both run linearly between control points, and may be steep below each.
  for (const TransferFunction* function : {&a, &b})
    for (const double value : function->values())
      if (inside(value) && !(same(value) && same(std::nextafter(value, -std::numeric_limits<double>::infinity()))))
        return false;
  return true;
}

std::vector<glm::ivec3> changedCells(const LightMedium& before, const LightMedium& after, const Bricks& bricks) {
  std::vector<glm::ivec3> old = before.cells, now = after.cells, changed, kept;
  std::ranges::sort(old, comesBefore);
  std::ranges::sort(now, comesBefore);
  std::ranges::set_symmetric_difference(old, now, std::back_inserter(changed), comesBefore);
  std::ranges::set_intersection(old, now, std::back_inserter(kept), comesBefore);
  const bool samePlanes = before.planes == after.planes, sameTransfer = before.transfer == after.transfer;
  if (!samePlanes || !sameTransfer)
    for (const glm::ivec3& cell : kept) {
      const auto found = std::ranges::lower_bound(bricks.bricks, cell, comesBefore, &Brick::origin);
      Brick brick{cell, {bricks.background, bricks.background}, {}};
      if (found != bricks.bricks.end() && found->origin == cell) brick = *found;
      if (!(samePlanes || sameCut(before.planes, after.planes, cell, bricks.layout.interior)) ||
          !(sameTransfer || sameExtinction(before.transfer, after.transfer, brick)))
        changed.push_back(cell);
    }
  std::ranges::sort(changed, comesBefore);
  return changed;
}

LightEdit editOf(const std::vector<SweepTask>& all, const std::vector<glm::ivec3>& changed,
                 const std::vector<glm::ivec3>& both, const BrickLayout& layout, int spacing) {
  LightEdit edit;
  if (changed.empty()) return edit;
  std::vector<char> met(both.size(), 0);
  double cost = 0, whole = 0;
  for (const SweepTask& task : all) {
    SweepTask& part = edit.tasks.emplace_back(task);
    const int sign = task.directions.front().sign;
    part.paths.clear();
    for (const SweptDirection& direction : task.directions) {
      std::optional<PlaneWindow> paths;
      for (const glm::ivec3& cell : changed) {
        const Shadow shadow = shadowOf(cell, direction, layout, spacing);
        if (paths)
          paths->include(shadow.paths);
        else
          paths = shadow.paths;
        const int first = sign > 0 ? shadow.high : shadow.low;
        if (!part.firstLit || sign * first > sign * *part.firstLit) part.firstLit = first;
      }
      part.paths.push_back(paths.value_or(PlaneWindow{}));
    }
    for (std::size_t i = 0; i < task.directions.size(); ++i)
      for (std::size_t c = 0; c < both.size(); ++c) {
        ++whole;
        const Shadow shadow = shadowOf(both[c], task.directions[i], layout, spacing);
        // The neighbours of paths are followed, too.
        PlaneWindow followed = part.paths[i];
        followed.include({followed.u0 - 1, followed.u1 + 1, followed.v0 - 1, followed.v1 + 1});
        if (!overlap(shadow.paths, followed)) continue;
        met[c] = 1;
        // Of a brick that is met at its edge, few paths are followed.
        const auto share = [](int a0, int a1, int b0, int b1) {
          return static_cast<double>(std::min(a1, b1) - std::max(a0, b0)) / (a1 - a0);
        };
        const PlaneWindow &a = shadow.paths, &b = followed;
        const bool lit = sign > 0 ? shadow.low <= *part.firstLit : shadow.high >= *part.firstLit;
        cost += share(a.u0, a.u1, b.u0, b.u1) * share(a.v0, a.v1, b.v0, b.v1) * (lit ? 1 : kCarryCost);
      }
  }
  for (std::size_t c = 0; c < both.size(); ++c)
    if (met[c]) edit.bricks.push_back(both[c]);
  // Once for the medium before and once for the one after.
  edit.cost = whole > 0 ? 2 * cost / whole : 0;
  return edit;
}

std::optional<DirectionEdit> editOf(const std::vector<LightDirection>& before, const glm::dvec3& wholeBefore,
                                    const std::vector<LightDirection>& after, const glm::dvec3& wholeAfter) {
  using Key = std::tuple<double, double, double>;
  std::map<Key, glm::dvec3> old, now;
  const auto keyOf = [](const LightDirection& light) {
    return Key(light.direction.x, light.direction.y, light.direction.z);
  };
  for (const LightDirection& light : before) old[keyOf(light)] += light.radiance;
  for (const LightDirection& light : after) now[keyOf(light)] += light.radiance;
  const auto changeBy = [&](const glm::dvec3& scale) {
    // Shares of the whole light after the edit, as radiances.
    std::vector<LightDirection> change;
    const auto add = [&](const Key& key, const glm::dvec3& radiance) {
      const glm::dvec3 least = 1e-12 * wholeAfter, size = glm::abs(radiance);
      if (size.x > least.x || size.y > least.y || size.z > least.z)
        change.push_back({{std::get<0>(key), std::get<1>(key), std::get<2>(key)}, radiance});
    };
    for (const auto& [key, radiance] : now) {
      const auto found = old.find(key);
      const glm::dvec3 stays = found == old.end() ? glm::dvec3(0) : found->second * scale * wholeAfter;
      add(key, radiance - stays);
    }
    for (const auto& [key, radiance] : old)
      if (!now.contains(key)) add(key, -(radiance * scale * wholeAfter));
    return change;
  };
  for (int c = 0; c < 3; ++c)
    if ((wholeBefore[c] > 0) != (wholeAfter[c] > 0)) return std::nullopt;
  glm::dvec3 perWhole, kept;
  for (int c = 0; c < 3; ++c) {
    perWhole[c] = wholeBefore[c] > 0 ? 1 / wholeBefore[c] : 0;  // all radiances have been scaled alike
    kept[c] = wholeAfter[c] > 0 ? 1 / wholeAfter[c] : 0;        // radiances are what they were
  }
  DirectionEdit scaled{changeBy(perWhole), glm::dvec3(1)};
  DirectionEdit added{changeBy(kept), wholeBefore * kept};
  for (int c = 0; c < 3; ++c)
    if (wholeBefore[c] <= 0) added.scale[c] = 1;
  DirectionEdit& less = scaled.change.size() <= added.change.size() ? scaled : added;
  if (less.change.size() >= now.size()) return std::nullopt;
  return less;
}

}  // namespace umbrick
