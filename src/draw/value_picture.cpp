// SPDX-License-Identifier: Apache-2.0
#include "umbrick/draw/value_picture.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "umbrick/core/error.h"
#include "umbrick/core/short_number.h"
#include "umbrick/draw/hybrid_picture.h"
#include "umbrick/optics/projection_colour.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/scene/shading_lights.h"
#include "umbrick/scene/surface_light.h"

namespace umbrick {

bool showsValues(Mode mode) { return traitsOf(mode).ofValues || traitsOf(mode).surfaces; }

void checkSurfaces(const ResolvedScene& scene, const Range& values, int apron) {
  if (scene.surfaces.empty())
    throw InvalidArgument("surfaces: is empty, must be one value or more for the mode " + modeName(scene.mode));
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    const double value = scene.surfaces[i].value;
    // A surface parts what is larger from what is not.
    if (value >= values.min && value < values.max) continue;
    throw InvalidArgument("surfaces[" + std::to_string(i) + "].value: " + shortNumber(value, 9) +
                          " has no surface, the volume has values from " + shortNumber(values.min, 9) + " to " +
                          shortNumber(values.max, 9));
  }
  if (apron < surfaceApron(scene))
    throw InvalidArgument("bricks: surfaces need an apron of " + std::to_string(surfaceApron(scene)) +
                          " voxels, found " + std::to_string(apron));
}

int surfaceApron(const SceneSettings& scene) {
  return occlusionMethod(scene) ? std::max(kGradientApron, kSurfaceLightApron) : kGradientApron;
}

void checkSurfaceLight(const ResolvedScene& scene) {
  if (!occlusionMethod(scene)) return;
  if (!supports(Method::lightVolume, scene.model))
    throw InvalidArgument("model: " + modelName(scene.model) +
                          " on surfaces is integrated by the reference alone; rays render emission, cone, ambient and "
                          "lights");
  refuseConeRays(scene, "surfaces");
  if (scene.method != Method::lightVolume)
    throw InvalidArgument("method: " + methodName(scene.method) +
                          " is one of slices; surfaces take light from a light volume");
  requireClassification(scene);
}

void checkShading(const ResolvedScene& scene, int apron) {
  if (apron < kGradientApron)
    throw InvalidArgument("bricks: shading needs an apron of " + std::to_string(kGradientApron) + " voxels, found " +
                          std::to_string(apron));
  shadingLights(scene);
}

ResolvedScene mediumOf(const ResolvedScene& scene) {
  if (scene.mode == Mode::hybrid) return mediumBehind(scene);
  ResolvedScene medium = scene;
  if (scene.mode != Mode::xray) return medium;
  medium.model = Model::emission;
  medium.sampling.saturation = 0;
  medium.background.reset();
  return medium;
}

void showThrough(const ResolvedScene& scene, Picture& picture) {
  Image through(scene.camera.width, scene.camera.height, 1);
  for (std::size_t i = 0; i < through.pixels.size(); ++i) {
    float* const pixel = &picture.colour.pixels[4 * i];
    through.pixels[i] = 1 - pixel[3];
    storeOver(scene, pixel[3] > 0 ? xrayColour(through.pixels[i]) : glm::dvec4(0), pixel);
  }
  picture.layers.push_back({"value", std::move(through), true});
}

void storeOver(const ResolvedScene& scene, const glm::dvec4& premultiplied, float* out) {
  const glm::dvec3 behind = scene.background.value_or(glm::dvec3(0));
  for (int c = 0; c < 3; ++c) out[c] = static_cast<float>(premultiplied[c] + (1 - premultiplied.w) * behind[c]);
  out[3] = scene.background ? 1 : static_cast<float>(premultiplied.w);
}

void storeProjected(const ResolvedScene& scene, double value, double background, float* out) {
  const bool nothing = isBackground(scene.transfer, value, background);
  storeOver(scene, nothing ? glm::dvec4(0) : projectionColour(scene.transfer, value), out);
}

WorldRay worldRay(const Camera& camera, const CameraFrame& frame, const glm::dvec2& screen) {
  const glm::dvec3 aside = screen.x * frame.right + screen.y * frame.up;
  const bool perspective = camera.projection == Projection::perspective;
  WorldRay ray;
  ray.from = perspective ? camera.eye : camera.eye + aside;
  ray.along = perspective ? frame.forward + aside : frame.forward;
  ray.viewer = -glm::normalize(ray.along);
  return ray;
}

SurfaceLayers::SurfaceLayers(int width, int height)
    : value_(width, height, 1), position_(width, height, 3), normal_(position_) {
  for (Image* image : {&value_, &position_, &normal_})
    std::ranges::fill(image->pixels, std::numeric_limits<float>::quiet_NaN());
}

void SurfaceLayers::keep(int x, int y, double value, const glm::dvec3& position, const glm::dvec3& normal) {
  *value_.at(x, y) = static_cast<float>(value);
  for (int c = 0; c < 3; ++c) {
    position_.at(x, y)[c] = static_cast<float>(position[c]);
    normal_.at(x, y)[c] = static_cast<float>(normal[c]);
  }
}

void SurfaceLayers::moveTo(Picture& picture) {
  picture.layers.push_back({"value", std::move(value_), true});
  picture.layers.push_back({"position", std::move(position_), true});
  picture.layers.push_back({"normal", std::move(normal_), true});
}

}  // namespace umbrick
