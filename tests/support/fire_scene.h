// Grids with a second one that emits light, and scenes that show it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <algorithm>
#include <vector>

#include "support/test_scenes.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

/// The first grid with the values of the second one, which lie on the same lattice.
inline ScalarGrid withEmission(ScalarGrid first, const ScalarGrid& second) {
  first.emission = second.grid;
  return first;
}

/// A medium that emits, without other light unless `ambient` is above 0.
/// @param emitted  sigma_s is the radiance per world unit
inline ResolvedScene fireScene(const TransferFunction& transfer, const TransferFunction& emitted, const Camera& camera,
                               double spacing = 0.5, double ambient = 0) {
  ResolvedScene scene = plainScene(transfer, camera, spacing);
  scene.volume.emissionGrid = "fire";
  scene.emission.kind = EmissionKind::table;
  scene.emission.table = emitted;
  scene.emitted = emissionFunction(scene.emission);
  scene.ambient = glm::dvec3(ambient);
  return scene;
}

/// Radiance `light` per world unit at values from `low` to `high`.
inline TransferFunction glowing(const glm::dvec3& light, double low, double high) {
  const double most = std::max({light.r, light.g, light.b});
  const Medium dark{light / most, 0}, bright{light / most, most};
  return TransferFunction({{low, dark}, {low, bright}, {high, bright}, {high, dark}});
}

/// Nothing that scatters or absorbs.
inline TransferFunction clearAir() { return homogeneous(glm::dvec3(0.5), 0); }

}  // namespace umbrick
