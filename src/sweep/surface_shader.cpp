// SPDX-License-Identifier: Apache-2.0
#include "sweep/surface_shader.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "umbrick/scene/capabilities.h"

namespace umbrick {

SurfaceShader::SurfaceShader(const ResolvedScene& scene, const glm::dmat4& indexToWorld, const glm::dvec3& whole)
    : ambient_(scene.ambient), whole_(whole), toWorld_(glm::transpose(glm::inverse(glm::dmat3(indexToWorld)))) {
  for (const SceneSurface& surface : scene.surfaces)
    colours_.push_back(surface.colour.value_or(scene.transfer(surface.value, 0).albedo));
  if (isShaded(scene)) phong_.emplace(scene);
}

glm::dvec3 SurfaceShader::normalOf(const glm::dvec3& gradient, const glm::dvec3& viewer) const {
  const glm::dvec3 rise = toWorld_ * gradient;
  const double length = glm::length(rise);
  // Where the value has no gradient the surface has no side of its own and faces the viewer.
  const glm::dvec3 normal = length > 0 ? rise / length : viewer;
  return glm::dot(normal, viewer) < 0 ? -normal : normal;
}

glm::dvec3 SurfaceShader::shade(std::size_t surface, const glm::dvec3& normal, const glm::dvec3& viewer,
                                const glm::dvec3& share) const {
  const glm::dvec3& colour = colours_[surface];
  return ambient_ * (phong_ ? (*phong_)(colour, normal, viewer, share) : colour * (share * whole_));
}

}  // namespace umbrick
