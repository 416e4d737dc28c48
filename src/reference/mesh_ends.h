// Where rays end at a scene's mesh, and what they see there, in double precision.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>

#include "reference/eye_ray.h"
#include "reference/phong_model.h"

namespace umbrick {

/// The end of a ray at a mesh.
struct MeshEnd {
  double t = 0;             // on the ray
  glm::dvec3 reflected{0};  // towards the eye, where light.ambient is 1
};
inline double endOf(const std::optional<MeshEnd>& end) {
  return end ? end->t : std::numeric_limits<double>::infinity();
}

/// Several threads may ask it at the same time.
class MeshEnds {
 public:
  /// @param scene  with a mesh  @throw InvalidArgument  as shadingLights
  MeshEnds(const ResolvedScene& scene, const glm::dmat4& indexToWorld);
  std::optional<MeshEnd> find(const EyeRays::Ray& ray) const;
  /// Tells whether the mesh is in the way of the light that comes along a ray.
  bool isAlong(const IndexRay& ray) const;

 private:
  std::shared_ptr<const Mesh> mesh_;
  glm::dvec3 colour_;
  std::optional<PhongModel> phong_;  // none: the mesh is flat
  double near_;                      // depth
  glm::dmat4 indexToWorld_;
};

/// Returns where rays of a scene end; none: it has no mesh.
std::optional<MeshEnds> meshEnds(const ResolvedScene& scene, const glm::dmat4& indexToWorld);

}  // namespace umbrick
