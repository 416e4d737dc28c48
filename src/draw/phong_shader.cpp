// SPDX-License-Identifier: Apache-2.0
#include "umbrick/draw/phong_shader.h"

#include <glm/geometric.hpp>

#include "umbrick/optics/phong.h"

namespace umbrick {

PhongShader::PhongShader(const ResolvedScene& scene) : shading_(scene.shading), lights_(shadingLights(scene)) {}

glm::dvec3 PhongShader::operator()(const glm::dvec3& colour, const glm::dvec3& normal, const glm::dvec3& viewer,
                                   const glm::dvec3& share) const {
  glm::dvec3 sum(0);
  const auto cosine = [](const glm::dvec3& a, const glm::dvec3& b) { return static_cast<float>(glm::dot(a, b)); };
  const auto reflect = [&](const glm::dvec3& towards, const glm::dvec3& radiance) {
    const float normalLight = cosine(normal, towards);
    const double diffuse = shading_.diffuse * phongDiffuse(normalLight);
    const double specular =
        shading_.specular * phongSpecular(normalLight, cosine(normal, viewer), cosine(towards, viewer),
                                          static_cast<float>(shading_.shininess));
    sum += radiance * (diffuse * colour + specular);
  };
  if (lights_.empty()) reflect(viewer, glm::dvec3(1));
  for (const ShadingLightRay& light : lights_) reflect(light.towards, light.radiance);
  return shading_.ambient * colour + share * sum;
}

}  // namespace umbrick
