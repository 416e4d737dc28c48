// Surfaces that light reaches through a medium: scenes whose pictures are known.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "support/small_blobs.h"
#include "support/test_scenes.h"

namespace umbrick {

/// A floor at z = 8.25, and above it a slab of another value from 13 to 20 in which a medium lies.
inline ScalarGrid floorGrid() {
  return makeFilled({32, 32, 24}, glm::ivec3(0), [](const glm::ivec3& i) {
    return i.z <= 8 ? 1.0 : i.z >= 14 && i.z <= 19 ? 0.5 : 0.0;
  });
}

/// The slab's medium: sigma_t at its value, none at values that differ by 0.1. On both of its faces values fall by 0.5
/// within a voxel, of which the medium takes a fifth and has half of its sigma_t there.
inline TransferFunction slabTransfer(double sigma_t) {
  const auto medium = [](double sigma) { return Medium{glm::dvec3(1), sigma}; };
  return TransferFunction({{0.4, medium(0)}, {0.5, medium(sigma_t)}, {0.6, medium(0)}});
}
inline double slabDepth(double sigma_t) { return sigma_t * (5 + 2 * 0.2 * 0.5); }

/// Looks straight down on the middle of the floor, which light reaches from one direction of the world.
inline ResolvedScene floorScene(double sigma_t, const glm::dvec3& towardsLight, const glm::dvec3& radiance) {
  ResolvedScene scene =
      plainScene(slabTransfer(sigma_t), orthographicCamera({15.5, 15.5, 60}, {15.5, 15.5, 8}, 6, 4), 0.5);
  scene.camera.up = {0, 1, 0};
  scene.mode = Mode::isosurface;
  scene.surfaces = {{0.75, glm::dvec3(0.8, 0.6, 0.4), 1}};
  scene.model = Model::lights;
  scene.method = Method::lightVolume;
  scene.lights = {{LightFrame::world, ConeLight{towardsLight, 0, radiance}}};
  return scene;
}

/// The floor again, and the slab as a roof of the same value: a surface that lets a share through, lit and seen from
/// straight above, without a medium. The light at each of four crossings, of which the last is the lower face of the
/// volume, has crossed those above it.
inline ResolvedScene roofScene(double opacity) {
  ResolvedScene scene = floorScene(0, {0, 0, 1}, glm::dvec3(1));
  scene.shading.kind = Shading::none;
  scene.surfaces = {{0.25, glm::dvec3(0.8, 0.6, 0.4), opacity}};
  return scene;
}
inline double roofShare(double opacity) {
  const double through = (1 - opacity) * (1 - opacity);
  return opacity * (1 + through + std::pow(through, 2) + std::pow(through, 3));
}

/// Soft blobs with a surface, of which a medium holds light off. @param kind  0 to 3: cone, ambient, lights of two
/// colours, cone on flat surfaces
inline ResolvedScene litBlobs(const ScalarGrid& grid, Projection projection, int kind, int size) {
  Camera base;
  base.width = base.height = size;
  base.projection = projection;
  const TransferFunction transfer({{0.15, {{0.9, 0.6, 0.3}, 0}}, {1, {{0.4, 0.7, 0.9}, 0.6}}});
  ResolvedScene scene = plainScene(transfer, orbitCamera(grid.worldBounds(), 1.7, 0.4, base), 0.5);
  scene.mode = Mode::isosurface;
  scene.surfaces = {{0.35, glm::dvec3(0.9, 0.8, 0.5), 0.6}, {0.6, glm::dvec3(0.3, 0.5, 0.9), 1}};
  scene.method = Method::lightVolume;
  scene.model = kind == 1 ? Model::ambient : kind == 2 ? Model::lights : Model::cone;
  scene.occlusion.aperture = 0.7;
  scene.occlusion.ordinates.directions = 64;
  scene.lights = {{LightFrame::world, ConeLight{{1, 2, 3}, 0.3, {1, 0.7, 0.2}}},
                  {LightFrame::view, ConeLight{{-1, 0.5, 1}, 0, {0, 0.2, 0.5}}}};
  if (kind == 3) scene.shading.kind = Shading::none;
  return scene;
}

/// A medium of one slope, constant extinction and albedo, that is lit along the view axis, from where it reflects. What
/// falls off on the way in falls off on the way out, too.
struct ReflectingBlock {
  static constexpr double kSigma = 0.1, kAmbient = 0.15, kDiffuse = 0.7;
  glm::dvec3 slope{0.02, 0.01, 0.04}, albedo{0.8, 0.5, 0.25};
  ScalarGrid grid =
      makeFilled(glm::ivec3(32), glm::ivec3(0), [this](const glm::ivec3& i) { return glm::dot(slope, glm::dvec3(i)); });
  ResolvedScene scene = plainScene(TransferFunction({{0, {albedo, kSigma}}, {3, {albedo, kSigma}}}),
                                   orthographicCamera({40, 30, 80}, glm::dvec3(15.5), 6, 8), 0.25);
  ReflectingBlock() {
    scene.shading = {Shading::phong, ShadingLight::automatic, kAmbient, kDiffuse, 0, 1};
    scene.clipBox = Box{glm::dvec3(8), glm::dvec3(24)};
    scene.model = Model::lights;
    scene.method = Method::lightVolume;
    scene.lights = {{LightFrame::view, ConeLight{{0, 0, 1}, 0, glm::dvec3(1)}}};
  }
  /// The colour of a pixel of an opacity: of 1 - exp(-tau) what is ambient, and (1 - exp(-2 tau)) / 2 of the light.
  double colourOf(double alpha, int channel) const {
    const double facing = std::abs(glm::dot(glm::normalize(slope), cameraFrame(scene.camera).forward));
    return albedo[channel] * (kAmbient * alpha + kDiffuse * facing * (1 - (1 - alpha) * (1 - alpha)) / 2);
  }
};

}  // namespace umbrick
