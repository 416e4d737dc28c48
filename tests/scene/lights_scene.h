// A resolved scene for its lights' sake.
#pragma once
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

inline glm::dvec3 towardsViewer(const Scene& scene) { return -cameraFrame(scene.camera).forward; }

}  // namespace umbrick
