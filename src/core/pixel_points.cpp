// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/pixel_points.h"

#include <algorithm>
#include <glm/common.hpp>

#include "umbrick/core/error.h"

namespace umbrick {

std::vector<glm::dvec2> pixelPoints(int count) {
  if (count < 1) throw InvalidArgument("pixel samples: found " + std::to_string(count) + ", must be at least 1");
  std::vector<int> columns;
  for (int i = 0; i < count; ++i) columns.push_back(i);
  std::sort(columns.begin(), columns.end(),
            [](int a, int b) { return glm::fract((a + 1) * kGoldenStep) < glm::fract((b + 1) * kGoldenStep); });
  std::vector<glm::dvec2> points(columns.size());
  for (int row = 0; row < count; ++row) {
    const int column = columns[static_cast<std::size_t>(row)];
    points[static_cast<std::size_t>(column)] = (glm::dvec2(column, row) + 0.5) / static_cast<double>(count);
  }
  return points;
}

std::string pixelFilter(int count) {
  return count == 1 ? "point, the centre of each pixel" : "box, " + std::to_string(count) + " samples a pixel";
}

}  // namespace umbrick
