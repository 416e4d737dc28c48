// Scenes that are lit by cone rays, and what is right for them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "support/test_grids.h"
#include "support/test_scenes.h"
#include "umbrick/reference/reference.h"
#include "umbrick/scene/lights.h"

namespace umbrick {

inline TransferFunction tintedRamp(double sigma_t) {
  return TransferFunction({{0, {{0.9, 0.6, 0.3}, 0}}, {1, {{0.9, 0.6, 0.3}, sigma_t}}});
}

inline ResolvedScene coneRayScene(const TransferFunction& transfer, const Camera& camera, double spacing,
                                  int directions) {
  ResolvedScene scene = plainScene(transfer, camera, spacing);
  scene.model = Model::cone;
  scene.method = Method::coneRays;
  scene.occlusion.aperture = 60 * kDegree;
  scene.occlusion.ordinates.directions = directions;
  return scene;
}

/// The reference with the directions that a renderer takes.
inline Image sameLightsReference(const ScalarGrid& grid, const ResolvedScene& scene, double tolerance) {
  ReferenceOptions options;
  options.lights = lightDirections(scene, scene.occlusion.ordinates.directions);
  options.tolerance = tolerance;
  return renderReference(grid, scene, options).colour;
}

/// A slab of constant sigma_t from z = 4 to 20 that is seen along z, whose light comes from the eye's side in
/// directions of cosine c: a point at depth x is lit by exp(-sigma_t x / c), so that the slab sends
///   albedo sum_k w_k c / (1 + c) (1 - exp(-sigma_t L (1 + 1/c))).
struct LitSlab {
  static constexpr double kSigma = 0.1, kThickness = 16;
  static constexpr int kDirections = 16;
  ScalarGrid grid = makeFilled(glm::ivec3(64, 64, 24), glm::ivec3(0), [](const glm::ivec3&) { return 1.0; });
  ResolvedScene scene;
  double perAlbedo = 0;  // what the slab sends

  explicit LitSlab(double spacing)
      : scene(coneRayScene(homogeneous({0.8, 0.5, 0.25}, kSigma), seen(), spacing, kDirections)) {
    scene.occlusion.aperture = 40 * kDegree;
    scene.clipBox = Box{{1, 1, 4}, {62, 62, 20}};
    for (const LightDirection& light : lightDirections(scene, kDirections)) {
      const double c = light.direction.z;
      perAlbedo += light.radiance.r * c / (1 + c) * -std::expm1(-kSigma * kThickness * (1 + 1 / c));
    }
  }
  static double opacity() { return -std::expm1(-kSigma * kThickness); }

 private:
  static Camera seen() {
    Camera camera = orthographicCamera({32, 32, 80}, {32, 32, 12}, 2, 2);
    camera.up = {0, 1, 0};
    return camera;
  }
};

}  // namespace umbrick
