// Surfaces with a medium behind them: scenes whose pictures are known, and a tube to look around in.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "support/small_blobs.h"
#include "support/test_scenes.h"

namespace umbrick {

inline ResolvedScene hybridScene(const TransferFunction& transfer, const Camera& camera,
                                 std::vector<SceneSurface> surfaces) {
  ResolvedScene scene = plainScene(transfer, camera, 0.25);
  scene.mode = Mode::hybrid;
  scene.surfaces = std::move(surfaces);
  return scene;
}

/// Values that fall along z by 0.05 a voxel, from 1 at 0 on.
inline ScalarGrid fallingGrid() {
  return makeFilled(glm::ivec3(20), glm::ivec3(0), [](const glm::ivec3& i) { return 0.05 * (20 - i.z); });
}

/// Looks from +z at it, with a surface of red at 0.3 (z = 14) and one of green at 0.6 (z = 8), in a medium of
/// constant extinction kDense.
inline constexpr double kDense = 0.1;
inline constexpr glm::dvec3 kBlue{0.1, 0.2, 0.9};
inline ResolvedScene fallingScene(double redOpacity) {
  ResolvedScene scene =
      hybridScene(homogeneous(kBlue, kDense), orthographicCamera({9.5, 9.5, 60}, glm::dvec3(9.5), 8, 4),
                  {{0.6, glm::dvec3(0, 1, 0), 0.25}, {0.3, glm::dvec3(1, 0, 0), redOpacity}});
  scene.camera.up = {0, 1, 0};
  scene.shading.kind = Shading::none;
  scene.clipBox = Box{{0, 0, 1}, {19, 19, 18}};
  return scene;
}

/// A colon: air in a bent tube with folds, a wall of 1 and tissue of 0.4 around it. The tube is closed to a ring of
/// radius kColonRing about (20, 20) in the slice z = 10.
inline constexpr double kColonRing = 12;
inline double colonAt(const glm::ivec3& i) {
  const glm::dvec3 p = glm::dvec3(i) - glm::dvec3(20, 20, 10);
  const double angle = std::atan2(p.y, p.x), aside = std::hypot(p.x, p.y) - kColonRing;
  const double outside = std::hypot(aside, p.z) - (4.5 + 0.6 * std::cos(9 * angle));
  const double tissue = outside < 1.5 ? 1 : std::max(0.4, 1 - 0.3 * (outside - 1.5));
  return std::clamp(0.5 + 0.4 * outside, 0.0, tissue);
}
inline ScalarGrid colonGrid() { return makeFilled({41, 41, 21}, glm::ivec3(0), colonAt); }

/// Air is clear, the wall and what lies behind it scatter.
inline TransferFunction colonTransfer() {
  return TransferFunction({{0.2, {{0.9, 0.5, 0.4}, 0}}, {0.45, {{0.9, 0.8, 0.3}, 0.15}}, {1, {{0.9, 0.4, 0.3}, 0.5}}});
}

/// Looks along the tube from within it. @param fov  rad
inline Camera colonCamera(double fov, int size) {
  Camera camera = perspectiveCamera({20 + kColonRing, 20, 10}, {20 + kColonRing - 2, 30, 10.5}, fov, size);
  camera.up = {0, 0, 1};
  return camera;
}

/// The same medium is seen by hybrid behind a clear surface that lies before all of it, and by integrate.
inline TransferFunction nothingBelow(double value) {
  return TransferFunction({{value, {{0.9, 0.6, 0.3}, 0}}, {1, {{0.4, 0.7, 0.9}, 0.8}}});
}

}  // namespace umbrick
