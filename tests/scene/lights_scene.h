// A resolved scene that is made for its lights.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <vector>

#include "umbrick/scene/lights.h"

namespace umbrick {

/// Returns a scene whose camera looks along no axis. The lights may be ones that no scene could be resolved with.
inline ResolvedScene sceneWith(const std::vector<LightSource>& lights) {
  Scene scene;
  scene.transfer = TransferFunction({{0, {glm::dvec3(1), 1}}});  // no light depends on it
  scene.orbit.reset();
  scene.camera.eye = {3, -2, 5};
  scene.camera.lookAt = {0.5, 1, -1};
  scene.camera.up = {0.2, 1, 0.1};
  ResolvedScene resolved = resolveScene(scene, {}, glm::dmat4(1));
  resolved.model = Model::lights;
  resolved.method = Method::ordinates;  // which takes light from the viewer's side
  resolved.lights = lights;
  return resolved;
}

/// Returns the integral of the light times a function of the direction.
inline glm::dvec3 applied(const std::vector<LightDirection>& directions,
                          const std::function<double(const glm::dvec3&)>& f) {
  glm::dvec3 sum(0);
  for (const LightDirection& light : directions) sum += light.radiance * f(light.direction);
  return sum;
}
inline glm::dvec3 total(const std::vector<LightDirection>& directions) {
  return applied(directions, [](const glm::dvec3&) { return 1.0; });
}

inline glm::dvec3 towardsViewer(const ResolvedScene& scene) { return -cameraFrame(scene.camera).forward; }

}  // namespace umbrick
