// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/pixel_points.h"

#include <algorithm>
#include <glm/common.hpp>
#include <numbers>

#include "umbrick/core/error.h"

namespace umbrick {

namespace {

// Returns the numbers below `count` in the order of the fractions of the multiples of a step.
std::vector<int> ordered(int count, double step) {
  if (count < 1) throw InvalidArgument("pixel samples: found " + std::to_string(count) + ", must be at least 1");
  std::vector<int> numbers;
  for (int i = 0; i < count; ++i) numbers.push_back(i);
  std::sort(numbers.begin(), numbers.end(),
            [step](int a, int b) { return glm::fract((a + 1) * step) < glm::fract((b + 1) * step); });
  return numbers;
}

}  // namespace

std::vector<glm::dvec2> pixelPoints(int count) {
  const std::vector<int> columns = ordered(count, kGoldenStep);
  std::vector<glm::dvec2> points(columns.size());
  for (int row = 0; row < count; ++row) {
    const int column = columns[static_cast<std::size_t>(row)];
    points[static_cast<std::size_t>(column)] = (glm::dvec2(column, row) + 0.5) / static_cast<double>(count);
  }
  return points;
}

std::vector<double> pixelTimes(int count) {
  const std::vector<int> order = ordered(count, std::numbers::sqrt2);
  std::vector<double> times(order.size());
  for (int part = 0; part < count; ++part)
    times[static_cast<std::size_t>(order[static_cast<std::size_t>(part)])] = (part + 0.5) / count;
  return times;
}

std::string pixelFilter(int count) {
  return count == 1 ? "point, the centre of each pixel" : "box, " + std::to_string(count) + " samples a pixel";
}

}  // namespace umbrick
