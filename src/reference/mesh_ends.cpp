// SPDX-License-Identifier: Apache-2.0
#include "reference/mesh_ends.h"

#include "umbrick/mesh/mesh.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {

MeshEnds::MeshEnds(const ResolvedScene& scene, const glm::dmat4& indexToWorld)
    : mesh_(scene.mesh.shape),
      colour_(scene.mesh.colour),
      near_(scene.camera.nearDistance),
      indexToWorld_(indexToWorld) {
  if (isMeshShaded(scene)) phong_.emplace(scene);
}

std::optional<MeshEnd> MeshEnds::find(const EyeRays::Ray& ray) const {
  const glm::dvec3 origin(indexToWorld_ * glm::dvec4(ray.index.origin, 1));
  const auto hit = mesh_->first(origin, ray.direction, near_ / ray.depthPerLength);
  if (!hit) return std::nullopt;
  const glm::dvec3 viewer = -ray.direction;
  const glm::dvec3 normal = glm::dot(hit->normal, viewer) < 0 ? -hit->normal : hit->normal;
  return MeshEnd{hit->t, phong_ ? phong_->ambient() * colour_ + phong_->direct(colour_, normal, viewer) : colour_};
}

bool MeshEnds::isAlong(const IndexRay& ray) const {
  const glm::dvec3 origin(indexToWorld_ * glm::dvec4(ray.origin, 1));
  return mesh_->first(origin, glm::dmat3(indexToWorld_) * ray.direction, 0).has_value();
}

std::optional<MeshEnds> meshEnds(const ResolvedScene& scene, const glm::dmat4& indexToWorld) {
  if (!scene.mesh.shape) return std::nullopt;
  return MeshEnds(scene, indexToWorld);
}

}  // namespace umbrick
