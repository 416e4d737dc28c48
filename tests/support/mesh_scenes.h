// Scenes with a mesh in the volume.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "support/small_blobs.h"
#include "support/test_meshes.h"
#include "support/test_scenes.h"

namespace umbrick {

inline SceneMesh sceneMesh(const TriangleMesh& mesh, const glm::dvec3& colour) {
  return {{}, std::make_shared<Mesh>(mesh), colour};
}

inline constexpr Mode kAllModes[]{Mode::integrate, Mode::mip,        Mode::minip, Mode::average,
                                  Mode::xray,      Mode::isosurface, Mode::hybrid};

/// Blobs with a sphere among them, of which a part is seen through the medium and a part beside it.
inline ResolvedScene meshScene(Mode mode, const Camera& camera) {
  const TransferFunction transfer({{0.1, {{0.9, 0.6, 0.3}, 0}}, {1, {{0.4, 0.7, 0.9}, 0.5}}});
  ResolvedScene scene = plainScene(transfer, camera, 0.25);
  scene.mode = mode;
  if (mode == Mode::isosurface || mode == Mode::hybrid) scene.surfaces = {{0.3, glm::dvec3(0.9, 0.8, 0.5), 0.5}};
  scene.mesh = sceneMesh(sphereMesh({13, 9, 12}, 5, 24), {0.2, 0.7, 0.4});
  return scene;
}

/// The same blobs in a light from aside, which the sphere keeps from them.
inline ResolvedScene shadowScene(Mode mode, const Camera& camera) {
  ResolvedScene scene = meshScene(mode, camera);
  scene.model = Model::lights;
  scene.method = Method::lightVolume;
  scene.lights = {{LightFrame::world, ConeLight{{0.5, -1, 0.3}, 0, {1, 0.8, 0.6}}}};
  return scene;
}

/// The same blobs from straight above, with a wall across them at z = kWall.
inline constexpr double kWall = 11.37;
inline ResolvedScene wallScene(Mode mode) {
  Camera camera = orthographicCamera({12, 12, 60}, {12, 12, 12}, 20, 20);
  camera.up = {0, 1, 0};
  ResolvedScene scene = meshScene(mode, camera);
  scene.mesh = sceneMesh(squareMesh({-50, -50}, {50, 50}, kWall), {0.2, 0.7, 0.4});
  scene.ambient = {0.9, 0.8, 0.7};
  return scene;
}
/// The scene without the wall, cut off where it is.
inline ResolvedScene cutAtWall(ResolvedScene scene) {
  scene.mesh = {};
  scene.clipPlanes = {{0, 0, 1, -kWall}};
  return scene;
}
/// What the wall makes of a pixel of that scene: it faces the headlight, so that all of Phong's model but highlights
/// is there.
inline double overWall(const ResolvedScene& scene, const float* pixel, int channel) {
  const ShadingOptions& k = scene.shading;
  const double wall = scene.mesh.colour[channel] * (k.ambient + k.diffuse) + k.specular;
  return pixel[channel] + (1 - static_cast<double>(pixel[3])) * scene.ambient[channel] * wall;
}

}  // namespace umbrick
