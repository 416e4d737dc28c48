// Phong's model in double precision.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "umbrick/scene/mode.h"
#include "umbrick/scene/shading_lights.h"

namespace umbrick {

class PhongModel {
 public:
  /// @throw InvalidArgument  as shadingLights
  explicit PhongModel(const ResolvedScene& scene) : shading_(scene.shading), lights_(shadingLights(scene)) {}

  double ambient() const { return shading_.ambient; }
  /// Returns what the lights send to the viewer from a surface of that colour, besides what is ambient. All directions
  /// are unit vectors of the world.
  glm::dvec3 direct(const glm::dvec3& colour, const glm::dvec3& normal, const glm::dvec3& viewer) const {
    glm::dvec3 sum(0);
    const auto reflect = [&](const glm::dvec3& towards, const glm::dvec3& radiance) {
      const double facing = glm::dot(normal, towards);
      if (!(facing > 0)) return;
      const double mirrored = std::max(0.0, glm::dot(2 * facing * normal - towards, viewer));
      sum +=
          radiance * (shading_.diffuse * facing * colour + shading_.specular * std::pow(mirrored, shading_.shininess));
    };
    if (lights_.empty()) reflect(viewer, glm::dvec3(1));
    for (const ShadingLightRay& light : lights_) reflect(light.towards, light.radiance);
    return sum;
  }

 private:
  ShadingOptions shading_;
  std::vector<ShadingLightRay> lights_;  // none: a headlight
};

}  // namespace umbrick
