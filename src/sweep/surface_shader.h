// The light that surfaces send to the eye.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat3x3.hpp>
#include <optional>
#include <vector>

#include "umbrick/core/camera.h"
#include "umbrick/draw/phong_shader.h"

namespace umbrick {

/// Shades points of a scene's surfaces by Phong's model, or gives them their colour. What light makes of both is in
/// umbrick/scene/surface_light.h.
class SurfaceShader {
 public:
  /// @param whole  light that arrives where nothing is in the way
  /// @throw InvalidArgument  as shadingLights
  SurfaceShader(const ResolvedScene& scene, const glm::dmat4& indexToWorld, const glm::dvec3& whole = glm::dvec3(1));

  /// Returns the normal in the world, on the viewer's side, unit length.
  /// @param gradient  of the value, per voxel
  /// @param viewer    direction towards the eye in the world, unit length
  glm::dvec3 normalOf(const glm::dvec3& gradient, const glm::dvec3& viewer) const;
  /// Returns the colour for all of a surface's opacity, linear.
  /// @param share  of the light, that arrives
  glm::dvec3 shade(std::size_t surface, const glm::dvec3& normal, const glm::dvec3& viewer,
                   const glm::dvec3& share) const;

 private:
  glm::dvec3 ambient_{1}, whole_{1};
  glm::dmat3 toWorld_{1};  // of gradients
  std::vector<glm::dvec3> colours_;
  std::optional<PhongShader> phong_;  // none: surfaces are flat
};

}  // namespace umbrick
