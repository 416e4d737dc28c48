// SPDX-License-Identifier: Apache-2.0
#include "shade/footprint.h"

#include <cmath>

namespace umbrick {
namespace {

glm::dvec2 squareToDisk(const glm::dvec2& p) {
  constexpr double kQuarterPi = 0.78539816339744831;
  if (p.x == 0 && p.y == 0) return {0, 0};
  const bool wide = std::abs(p.x) > std::abs(p.y);
  const double radius = wide ? p.x : p.y;
  const double angle = wide ? kQuarterPi * (p.y / p.x) : 2 * kQuarterPi - kQuarterPi * (p.x / p.y);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace

std::vector<glm::dvec2> diskGrid(int n) {
  std::vector<glm::dvec2> points;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) points.push_back(squareToDisk({(2.0 * i + 1 - n) / n, (2.0 * j + 1 - n) / n}));
  return points;
}

}  // namespace umbrick
