// SPDX-License-Identifier: Apache-2.0
#include "umbrick/scene/shading_lights.h"

#include <glm/geometric.hpp>

#include "core/overload.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {

std::vector<ShadingLightRay> shadingLights(const ResolvedScene& scene) {
  const bool sources = scene.shading.light == ShadingLight::automatic ? traitsOf(scene.model).sources
                                                                      : scene.shading.light == ShadingLight::sources;
  if (!sources) return {};
  const CameraFrame frame = cameraFrame(scene.camera);
  std::vector<ShadingLightRay> lights;
  for (const LightSource& source : scene.lights) {
    const auto add = [&](const glm::dvec3& direction, const glm::dvec3& radiance) {
      const glm::dvec3 world = source.frame == LightFrame::world
                                   ? direction
                                   : direction.x * frame.right + direction.y * frame.up - direction.z * frame.forward;
      lights.push_back({glm::normalize(world), radiance});
    };
    std::visit(Overload{[&](const ConeLight& cone) { add(cone.axis, cone.radiance); },
                        [&](const ListedLight& light) {
                          for (const ListedDirection& listed : light.list)
                            add(listed.direction, listed.weight * listed.colour);
                        },
                        [](const EnvironmentLight&) {}},
               source.light);
  }
  if (lights.empty())
    throw InvalidArgument(
        "shading.light: the scene has no directional source that Phong's model could reflect; "
        "headlight needs none");
  return lights;
}

}  // namespace umbrick
