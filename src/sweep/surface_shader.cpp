// SPDX-License-Identifier: Apache-2.0
#include "sweep/surface_shader.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "umbrick/optics/phong.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {

SurfaceShader::SurfaceShader(const ResolvedScene& scene, const glm::dmat4& indexToWorld)
    : shading_(scene.shading),
      shaded_(isShaded(scene)),
      ambient_(scene.ambient),
      toWorld_(glm::transpose(glm::inverse(glm::dmat3(indexToWorld)))) {
  for (const SceneSurface& surface : scene.surfaces)
    colours_.push_back(surface.colour.value_or(scene.transfer(surface.value, 0).albedo));
  if (shaded_) lights_ = shadingLights(scene);
}

ShadedSurface SurfaceShader::shade(std::size_t surface, const glm::dvec3& gradient, const glm::dvec3& viewer) const {
  ShadedSurface shaded;
  const glm::dvec3 rise = toWorld_ * gradient;
  const double length = glm::length(rise);
  // Where the value has no gradient the surface has no side of its own and faces the viewer.
  shaded.normal = length > 0 ? rise / length : viewer;
  if (glm::dot(shaded.normal, viewer) < 0) shaded.normal = -shaded.normal;
  const glm::dvec3& colour = colours_[surface];
  if (!shaded_) {
    shaded.colour = ambient_ * colour;
    return shaded;
  }
  shaded.colour = shading_.ambient * colour;
  const auto cosine = [](const glm::dvec3& a, const glm::dvec3& b) { return static_cast<float>(glm::dot(a, b)); };
  const auto reflect = [&](const glm::dvec3& towards, const glm::dvec3& radiance) {
    const float normalLight = cosine(shaded.normal, towards);
    const double diffuse = shading_.diffuse * phongDiffuse(normalLight);
    const double specular =
        shading_.specular * phongSpecular(normalLight, cosine(shaded.normal, viewer), cosine(towards, viewer),
                                          static_cast<float>(shading_.shininess));
    shaded.colour += radiance * (diffuse * colour + specular);
  };
  if (lights_.empty()) reflect(viewer, glm::dvec3(1));
  for (const ShadingLightRay& light : lights_) reflect(light.towards, light.radiance);
  shaded.colour *= ambient_;
  return shaded;
}

}  // namespace umbrick
