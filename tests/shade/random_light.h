// Random slices and directions of the light, for tests of its geometry and its plans.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/geometric.hpp>
#include <vector>

#include "shade/light_plan.h"
#include "support/test_grids.h"

namespace umbrick {

inline Rectangle randomRectangle(TestRandom& random, double extent, double most) {
  const glm::dvec2 low(random.uniform(-extent, extent), random.uniform(-extent, extent));
  return {low, low + glm::dvec2(random.uniform(0.1, most), random.uniform(0.1, most))};
}

inline LightExtents randomExtents(TestRandom& random) {
  LightExtents extents;
  const double spacing = random.uniform(0.1, 3);
  extents.texel = random.uniform(0.2, 2);
  const int count = 1 + random.below(40);
  const int first = random.below(100);
  for (int i = 0; i < count; ++i) {
    extents.depths.push_back((first + i + 0.5) * spacing);
    const bool gap = random.uniform() < 0.2;
    extents.occluding.push_back(gap || random.uniform() < 0.1 ? Rectangle{} : randomRectangle(random, 8, 9));
    extents.seen.push_back(gap || random.uniform() < 0.3 ? Rectangle{} : randomRectangle(random, 8, 9));
  }
  return extents;
}

inline LightPaths randomPaths(TestRandom& random) {
  LightPaths paths;
  const int count = 1 + random.below(4);
  for (int k = 0; k < count; ++k)
    paths.lights.push_back(lightSlope(glm::normalize(
        glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform() < 0.2 ? 0.003 : random.uniform()))));
  return paths;
}

/// Returns the view axis and the directions of the light, in the order of LightRun::forEachWindow.
inline std::vector<LightSlope> slopesOf(const LightPaths& paths) {
  std::vector<LightSlope> slopes{paths.view};
  slopes.insert(slopes.end(), paths.lights.begin(), paths.lights.end());
  return slopes;
}

}  // namespace umbrick
