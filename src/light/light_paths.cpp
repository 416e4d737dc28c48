// SPDX-License-Identifier: Apache-2.0
#include "umbrick/light/light_paths.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <utility>

namespace umbrick {
namespace {

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

std::vector<SweepSide> sweepSides(std::span<const LightDirection> directions, const glm::dvec3& whole,
                                  const glm::dmat4& indexToWorld) {
  const glm::dmat3 toIndex = glm::inverse(glm::dmat3(indexToWorld));
  std::map<std::pair<int, int>, std::vector<SweptDirection>> byAxis;
  for (const LightDirection& light : directions) {
    SweptDirection swept = sweptDirection(light, toIndex);
    for (int c = 0; c < 3; ++c)
      swept.weight[static_cast<std::size_t>(c)] = static_cast<float>(whole[c] > 0 ? light.radiance[c] / whole[c] : 0);
    byAxis[{swept.axis, swept.sign}].push_back(swept);
  }
  std::vector<SweepSide> sides;
  for (auto& [key, list] : byAxis) sides.push_back({key.first, key.second, std::move(list)});
  return sides;
}

glm::dvec3 wholeLight(std::span<const LightDirection> directions) {
  glm::dvec3 whole(0);
  for (const LightDirection& light : directions) whole += light.radiance;
  return whole;
}

bool isColoured(std::span<const LightDirection> directions) {
  const glm::dvec3 whole = wholeLight(directions);
  const double power = whole.r + whole.g + whole.b;
  return std::ranges::any_of(directions, [&](const LightDirection& light) {
    const double share = power > 0 ? (light.radiance.r + light.radiance.g + light.radiance.b) / power : 0;
    const glm::dvec3 tint = glm::abs(light.radiance - share * whole);
    return std::max({tint.r, tint.g, tint.b}) > 1e-9 * power;
  });
}

PathCut pathCut(const glm::dvec4& plane, const SweptDirection& direction, const glm::dmat3& toIndex, int spacing) {
  const SweepAxes axes = kSweepAxes[direction.axis];
  const glm::dvec3 normal(plane[axes.u], plane[axes.v], plane[axes.n]), size = glm::abs(normal);
  PathCut cut;
  cut.rate = normal.x * direction.u + normal.y * direction.v - normal.z * direction.sign;
  if (std::abs(cut.rate) < 1e-6) cut.rate = 1e-6;
  const double perWorld = glm::length(glm::dvec3(plane) * toIndex);
  cut.slicesPerPlace = spacing * std::max({size.x, size.y, size.z}) / std::abs(cut.rate);
  cut.cosine = std::abs(cut.rate) / (perWorld * direction.length);
  return cut;
}

}  // namespace umbrick
