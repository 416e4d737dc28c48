#include "scene/scene_check.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "scene/checker.h"
#include "scene/light_check.h"
#include "scene/names.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

void checkCamera(Checker& check, const Camera& camera, const std::optional<Orbit>& orbit) {
  check.require(camera.width >= 1 && camera.height >= 1, "camera.size",
                std::to_string(camera.width) + " x " + std::to_string(camera.height), "at least 1 x 1");
  check.require(camera.fov > 0 && camera.fov < std::numbers::pi, "camera.fov", printDegrees(camera.fov), "in (0, 180)");
  check.require(camera.nearDistance >= 0 && std::isfinite(camera.nearDistance), "camera.near",
                print(camera.nearDistance), "0 or more");
  if (orbit) {
    check.require(std::isfinite(orbit->azimuth), "camera.azimuth", print(orbit->azimuth), "finite");
    check.require(std::isfinite(orbit->elevation), "camera.elevation", print(orbit->elevation), "finite");
    return;
  }
  check.require(camera.viewHeight > 0 && std::isfinite(camera.viewHeight), "camera.viewHeight",
                print(camera.viewHeight), "above 0");
  check.requireFinite(camera.eye, "camera.eye");
  check.requireFinite(camera.lookAt, "camera.lookAt");
  check.requireFinite(camera.up, "camera.up");
  if (check.complaint()) return;
  try {
    cameraFrame(camera);
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

// What a light of the world has in front of it is known where the camera stands: see lightDirections.
void checkLights(Checker& check, const Scene& scene) {
  check.require(scene.model != Model::lights || !scene.lights.empty(), "light.sources", "empty",
                "one source or more for the model lights");
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    check.add(findComplaint(scene.lights[i], i));
    if (scene.lights[i].frame == LightFrame::view) check.add(findBehindViewer(scene.lights[i], i, {0, 0, 1}));
  }
}

}  // namespace

std::optional<Complaint> findComplaint(const Scene& scene) {
  Checker check;
  checkCamera(check, scene.camera, scene.orbit);
  check.requireRadiance(scene.ambient, "light.ambient");
  if (scene.background) check.requireRadiance(*scene.background, "light.background");
  checkLights(check, scene);

  const SamplingOptions& sampling = scene.sampling;
  check.require(sampling.spacing > 0 && std::isfinite(sampling.spacing), "sampling.spacing", print(sampling.spacing),
                "above 0");
  check.requireWithin(sampling.segments, 1, 8, "sampling.segments");
  check.requireEither(sampling.bits, 16, 32, "sampling.bits");
  check.require(sampling.saturation >= 0 && sampling.saturation < 1, "sampling.saturation", print(sampling.saturation),
                "in [0, 1)");

  const OcclusionOptions& occlusion = scene.occlusion;
  check.require(occlusion.aperture >= 0 && occlusion.aperture < std::numbers::pi / 2, "occlusion.theta",
                printDegrees(occlusion.aperture), "in [0, 90)");
  check.requireWithin(occlusion.footprint, 1, 16, "occlusion.footprint");
  check.requireEither(occlusion.passes, 1, 2, "occlusion.passes");
  check.requireEither(occlusion.algorithm, 2, 3, "occlusion.algorithm");
  check.requireEither(occlusion.bits, 16, 32, "occlusion.bits");
  check.requireWithin(occlusion.directions, 1, 1024, "occlusion.directions");
  check.require(occlusion.scale >= 0 && std::isfinite(occlusion.scale), "occlusion.scale", print(occlusion.scale),
                "0 or more");

  checkClip(check, scene);

  const BrickSettings& bricks = scene.bricks;
  check.require(bricks.interior >= 0 && bricks.interior <= 256 && bricks.interior % 8 == 0, "bricks.interior",
                std::to_string(bricks.interior), "a multiple of 8 from 8 to 256, or 0 to have it chosen");
  bool known = false;
  std::string formats;
  for (const std::string_view format : kTexelFormats) {
    known = known || format == bricks.format;
    formats.append(formats.empty() ? "" : ", ").append(format);
  }
  check.require(known, "bricks.format", "'" + bricks.format + "'", "one of " + formats);
  check.require(bricks.budgetMiB >= 1 && bricks.budgetMiB <= (std::uint64_t(1) << 40), "bricks.budgetMiB",
                std::to_string(bricks.budgetMiB), "1 to 2^40");
  return check.complaint();
}

void validateScene(const Scene& scene) {
  if (const auto complaint = findComplaint(scene)) throw InvalidArgument(complaint->field + ": " + complaint->message);
}

}  // namespace umbrick
