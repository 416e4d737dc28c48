// Phong's model for surfaces and meshes on the CPU, which are shaded once where a ray meets them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "umbrick/scene/mode.h"
#include "umbrick/scene/shading_lights.h"

namespace umbrick {

class PhongShader {
 public:
  /// @throw InvalidArgument  as shadingLights
  explicit PhongShader(const ResolvedScene& scene);

  /// Returns what is sent to the viewer where light.ambient is 1; see umbrick/scene/surface_light.h.
  /// @param normal,viewer  unit vectors of the world; the normal is on the viewer's side
  /// @param share          of the light, that arrives
  glm::dvec3 operator()(const glm::dvec3& colour, const glm::dvec3& normal, const glm::dvec3& viewer,
                        const glm::dvec3& share) const;

 private:
  ShadingOptions shading_;
  std::vector<ShadingLightRay> lights_;  // none: a headlight
};

}  // namespace umbrick
