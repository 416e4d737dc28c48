// The light that surfaces send to the eye.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat3x3.hpp>
#include <vector>

#include "umbrick/core/camera.h"
#include "umbrick/scene/shading_lights.h"

namespace umbrick {

/// What is seen of a surface at a point.
struct ShadedSurface {
  glm::dvec3 colour{0};  // linear, for all of the surface's opacity
  glm::dvec3 normal{0};  // in the world, on the viewer's side, unit length
};

/// Shades points of a scene's surfaces by Phong's model, or gives them their colour.
class SurfaceShader {
 public:
  /// @throw InvalidArgument  as shadingLights
  SurfaceShader(const ResolvedScene& scene, const glm::dmat4& indexToWorld);

  /// @param gradient  of the value, per voxel
  /// @param viewer    direction towards the eye in the world, unit length
  ShadedSurface shade(std::size_t surface, const glm::dvec3& gradient, const glm::dvec3& viewer) const;

 private:
  ShadingOptions shading_;
  bool shaded_ = true;
  glm::dvec3 ambient_{1};
  glm::dmat3 toWorld_{1};  // of gradients
  std::vector<glm::dvec3> colours_;
  std::vector<ShadingLightRay> lights_;  // none: a headlight
};

}  // namespace umbrick
