// A resolved scene for its lights' sake.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <vector>

#include "umbrick/scene/lights.h"

namespace umbrick {

/// Its camera looks along no axis.
inline Scene sceneWith(const std::vector<LightSource>& lights) {
  Scene scene;
  scene.orbit.reset();
  scene.camera.eye = {3, -2, 5};
  scene.camera.lookAt = {0.5, 1, -1};
  scene.camera.up = {0.2, 1, 0.1};
  scene.model = Model::lights;
  scene.lights = lights;
  return scene;
}

/// What the light makes of a function of the direction.
inline glm::dvec3 applied(const std::vector<LightDirection>& directions,
                          const std::function<double(const glm::dvec3&)>& f) {
  glm::dvec3 sum(0);
  for (const LightDirection& light : directions) sum += light.radiance * f(light.direction);
  return sum;
}
inline glm::dvec3 total(const std::vector<LightDirection>& directions) {
  return applied(directions, [](const glm::dvec3&) { return 1.0; });
}

inline glm::dvec3 towardsViewer(const Scene& scene) { return -cameraFrame(scene.camera).forward; }

}  // namespace umbrick
