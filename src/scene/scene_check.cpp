// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_check.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "scene/checker.h"
#include "scene/field_text.h"
#include "scene/key_tracks.h"
#include "scene/light_check.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {

void checkFields(Checker& check, std::string_view section, Scene& scene) {
  for (const SceneField& field : sceneFields())
    if (field.section() == section) {
      const FieldPlace place = field.place(scene);
      check.require(inRange(place, field.range), std::string(field.path), messageText(place), rangeText(field));
    }
}

// Checks that eye, view direction and up make a frame, once each of them is in its range.
void checkFrame(Checker& check, const Scene& scene) {
  if (check.complaint()) return;
  if (scene.orbit) {
    const Orbit& orbit = *scene.orbit;
    if (orbit.up == Axis::automatic || orbit.front == Axis::automatic) return;
    check.require(glm::dot(axisDirection(orbit.up), axisDirection(orbit.front)) == 0, "camera.frontAxis",
                  "'" + std::string(nameOf(kAxes, orbit.front)) + "'",
                  "at right angles to upAxis '" + std::string(nameOf(kAxes, orbit.up)) + "'");
    return;
  }
  try {
    cameraFrame(scene.camera);
  } catch (const InvalidArgument& error) {
    std::string message = error.what();
    if (message.starts_with("camera: ")) message.erase(0, 8);
    check.complain("camera", message);
  }
}

void checkClip(Checker& check, const Scene& scene) {
  for (std::size_t i = 0; i < scene.clipPlanes.size(); ++i) {
    const ClipPlane& plane = scene.clipPlanes[i];
    const glm::dvec3 normal(plane);
    const std::string field = "clip.planes[" + std::to_string(i) + "]";
    const std::string is =
        "[" + print(plane.x) + ", " + print(plane.y) + ", " + print(plane.z) + ", " + print(plane.w) + "]";
    check.require(isFinite(normal) && std::isfinite(plane.w), field, is, "four finite numbers");
    check.require(glm::length(normal) > 0, field, is, "a plane whose normal, the first three numbers, is not 0");
  }
  if (!scene.clipBox) return;
  const Box& box = *scene.clipBox;
  check.require(
      isFinite(box.min) && isFinite(box.max) && box.min.x < box.max.x && box.min.y < box.max.y && box.min.z < box.max.z,
      "clip.box", print(box.min) + " to " + print(box.max), "two corners, each number of the first smaller");
}

// Checks lights of the view's frame. For a light of the world, what is in front of it is known where the camera is
// placed: see lightDirections.
void checkLights(Checker& check, const Scene& scene) {
  check.require(!traitsOf(scene.model).sources || !scene.lights.empty(), "light.sources", "empty",
                "one source or more for the model lights");
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    check.add(findComplaint(scene.lights[i], i));
    if (scene.lights[i].frame == LightFrame::view && !lightComesFromBehind(scene))
      check.add(findBehindViewer(scene.lights[i], i, {0, 0, 1}));
  }
}

void checkGradientOpacity(Checker& check, const Scene& scene) {
  const glm::dvec2& ramp = scene.gradientOpacity;
  check.require(ramp == glm::dvec2(0) || ramp.x < ramp.y, "gradientOpacity",
                "(" + print(ramp.x) + " " + print(ramp.y) + ")", "two numbers that ascend, or 0 0");
}

void checkSurfaces(Checker& check, const Scene& scene) {
  check.require(scene.surfaces.size() <= kMostSurfaces, "surfaces", std::to_string(scene.surfaces.size()),
                "at most " + std::to_string(kMostSurfaces));
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    const SceneSurface& surface = scene.surfaces[i];
    const std::string field = "surfaces[" + std::to_string(i) + "].";
    check.require(std::isfinite(surface.value), field + "value", print(surface.value), "finite");
    check.require(surface.opacity >= 0 && surface.opacity <= 1, field + "opacity", print(surface.opacity), "in [0, 1]");
    if (!surface.colour) continue;
    const glm::dvec3& c = *surface.colour;
    const bool inRange = std::min({c.r, c.g, c.b}) >= 0 && std::max({c.r, c.g, c.b}) <= 1;
    check.require(isFinite(c) && inRange, field + "colour", print(c), "three numbers in [0, 1]");
  }
}

}  // namespace

std::optional<Complaint> findComplaint(const Scene& given) {
  Scene scene = given;  // a copy, since a field's place is that of a scene that may be changed
  Checker check;
  checkFields(check, "camera", scene);
  checkFrame(check, scene);
  checkFields(check, "light", scene);
  checkLights(check, scene);
  checkFields(check, "", scene);
  checkGradientOpacity(check, scene);
  checkSurfaces(check, scene);
  checkFields(check, "mesh", scene);
  checkFields(check, "shading", scene);
  checkFields(check, "emission", scene);
  checkFields(check, "sampling", scene);
  checkFields(check, "occlusion", scene);
  checkClip(check, scene);
  checkFields(check, "bricks", scene);
  checkTracks(check, scene);
  return check.complaint();
}

void validateScene(const Scene& scene) {
  if (const auto complaint = findComplaint(scene)) throw InvalidArgument(complaint->field + ": " + complaint->message);
}

}  // namespace umbrick
