// SPDX-License-Identifier: Apache-2.0
#include "shade/phong_uniforms.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "umbrick/scene/capabilities.h"
#include "umbrick/scene/shading_lights.h"

namespace umbrick {

void setPhongConstants(ShaderConstants& constants, const ResolvedScene& scene) {
  const bool shaded = isShaded(scene);
  constants["kShaded"] = shaded;
  constants["kBspline"] = scene.gradients == GradientFilter::bspline;
  constants["kShadingLights"] = shaded ? static_cast<int>(shadingLights(scene).size()) : 0;
}

void setPhongUniforms(GlProgram& program, const ResolvedScene& scene, const glm::dmat4& indexToWorld) {
  const ShadingOptions& shading = scene.shading;
  program.set("phong", glm::vec4(shading.ambient, shading.diffuse, shading.specular, shading.shininess));
  std::vector<glm::vec3> towards, radiance;
  if (isShaded(scene))
    for (const ShadingLightRay& light : shadingLights(scene)) {
      towards.emplace_back(light.towards);
      radiance.emplace_back(light.radiance);
    }
  if (!towards.empty()) {
    program.set("light_towards", towards);
    program.set("light_radiance", radiance);
  }
  const CameraFrame frame = cameraFrame(scene.camera);
  program.set("view_right", glm::vec3(frame.right));
  program.set("view_up", glm::vec3(frame.up));
  program.set("view_forward", glm::vec3(frame.forward));
  const glm::mat3 toWorld(glm::transpose(glm::inverse(glm::dmat3(indexToWorld))));
  const std::vector<glm::vec3> columns{toWorld[0], toWorld[1], toWorld[2]};
  program.set("gradient_to_world", columns);
  const glm::mat4 world(indexToWorld);
  const std::vector<glm::vec3> axes{world[0], world[1], world[2]};
  program.set("index_to_world", axes);
}

}  // namespace umbrick
