// A scene of hard edges that cast shadows on each other.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <numbers>

#include "support/closed_forms.h"
#include "support/test_scenes.h"

namespace umbrick {

/// Walls, a shell and a translucent slab in front of a floor: hard edges at several heights, 48 voxels wide.
inline ScalarGrid courtyard() {
  const glm::dvec3 ball(30, 17, 18);
  return makeFilled(glm::ivec3(48), glm::ivec3(0), [&](const glm::ivec3& i) {
    const double r = glm::length(glm::dvec3(i) - ball);
    const bool floor = i.z < 5, wall = i.x >= 8 && i.x < 12 && i.z<34, post = i.x> 38 && i.y > 38 && i.z < 26;
    if (floor || wall || post || (r > 7 && r < 10)) return 1.0;
    return i.y > 24 && i.x > 14 && i.x < 36 && i.z > 28 && i.z < 34 ? 0.25 : 0.0;
  });
}

/// @param theta  degrees; the slices, so many, span 52 units
inline ResolvedScene courtyardScene(double theta, int slices) {
  const TransferFunction transfer({{0, {glm::dvec3(1), 0}},
                                   {0.25, {{0.5, 0.7, 1}, 0.04}},
                                   {0.4, {{0.9, 0.8, 0.6}, 0.1}},
                                   {1, {{0.9, 0.8, 0.6}, 3}}});
  ResolvedScene scene = plainScene(transfer, orthographicCamera({30, 10, 90}, {24, 23, 20}, 44, 48), 52.0 / slices);
  scene.model = Model::cone;
  scene.occlusion.aperture = theta * std::numbers::pi / 180;
  return scene;
}

}  // namespace umbrick
