// A medium that is smooth everywhere, for orders of convergence: nothing ends at a face or begins at a threshold.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>

#include "support/closed_forms.h"
#include "support/test_scenes.h"

namespace umbrick {

inline TransferFunction softTransfer() {
  return TransferFunction({{0, {{0.9, 0.3, 0.1}, 0}}, {1, {{0.2, 0.8, 0.5}, 0.8}}});
}

/// Voxels of edge `h`: a smooth field in world coordinates that fades away smoothly at 11 units from the centre.
inline ScalarGrid smoothGrid(double h) {
  const SmoothField field(4);
  const int count = static_cast<int>(std::lround(24 / h));
  return fieldGrid(
      {glm::ivec3(0), glm::ivec3(count)},
      [&](const glm::dvec3& p) {
        const glm::dvec3 r = (h * p - 12.0) / 11.0;
        const double window = std::max(0.0, 1 - glm::dot(r, r));
        return field(h * p) * window * window * window;
      },
      glm::dmat4(glm::dmat3(h)));
}

inline ResolvedScene smoothScene(Model model, int size) {
  ResolvedScene scene = plainScene(softTransfer(), perspectiveCamera({40, -18, 33}, {12, 12, 12}, 0.4, size), 1);
  scene.model = model;
  scene.occlusion.aperture = 1.1;
  return scene;
}

}  // namespace umbrick
