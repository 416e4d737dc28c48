#include <algorithm>
#include <glm/vec2.hpp>

#include "core/json_reader.h"
#include "core/text_file.h"
#include "scene/light_json.h"
#include "scene/names.h"
#include "scene/scene_check.h"
#include "umbrick/core/error.h"
#include "umbrick/optics/transfer_json.h"

namespace umbrick {
namespace {

// One function per kind of field: sets `target` when the field is there.
void read(const JsonValue& object, std::string_view key, double& target) {
  if (const auto value = object.find(key)) target = value->number();
}
void read(const JsonValue& object, std::string_view key, int& target) {
  if (const auto value = object.find(key)) target = value->integer();
}
void read(const JsonValue& object, std::string_view key, std::uint64_t& target) {
  if (const auto value = object.find(key)) target = value->unsignedInteger();
}
void read(const JsonValue& object, std::string_view key, bool& target) {
  if (const auto value = object.find(key)) target = value->boolean();
}
void read(const JsonValue& object, std::string_view key, std::string& target) {
  if (const auto value = object.find(key)) target = value->string();
}
void read(const JsonValue& object, std::string_view key, glm::dvec3& target) {
  if (const auto value = object.find(key)) {
    const std::vector<double> numbers = value->numbers(3);
    target = {numbers[0], numbers[1], numbers[2]};
  }
}
void readDegrees(const JsonValue& object, std::string_view key, double& radians) {
  if (const auto value = object.find(key)) radians = value->degrees();
}
template <typename T, std::size_t N>
void read(const JsonValue& object, std::string_view key, const Name<T> (&names)[N], T& target) {
  if (const auto value = object.find(key)) target = value->choice<T>(names);
}

void readVolume(const JsonValue& value, const std::filesystem::path& folder, VolumeReference& volume) {
  value.allowFields({"file", "grid"});
  if (const auto file = value.find("file")) volume.file = folder / file->string();
  read(value, "grid", volume.grid);
}

void readCamera(const JsonValue& value, Scene& scene) {
  value.allowFields({"projection", "azimuth", "elevation", "eye", "lookAt", "up", "fov", "viewHeight", "near", "size"});
  Camera& camera = scene.camera;
  read(value, "projection", kProjections, camera.projection);
  readDegrees(value, "fov", camera.fov);
  read(value, "near", camera.nearDistance);
  if (const auto size = value.find("size")) {
    const std::vector<JsonValue> items = size->items(2);
    camera.width = items[0].integer();
    camera.height = items[1].integer();
  }
  const bool placed = value.find("eye").has_value();
  if (!placed) {
    for (const char* key : {"lookAt", "up", "viewHeight"})
      if (const auto field = value.find(key))
        field->fail("needs 'eye': without it the camera is placed around the volume");
    readDegrees(value, "azimuth", scene.orbit->azimuth);
    readDegrees(value, "elevation", scene.orbit->elevation);
    return;
  }
  for (const char* key : {"azimuth", "elevation"})
    if (const auto field = value.find(key)) field->fail("places the camera, but so does 'eye': give one of them");
  scene.orbit.reset();
  read(value, "eye", camera.eye);
  read(value, "lookAt", camera.lookAt);
  read(value, "up", camera.up);
  read(value, "viewHeight", camera.viewHeight);
}

TransferFunction readTransfer(const JsonValue& value, const std::filesystem::path& folder) {
  if (!value.isString()) return readTransferFunction(value);
  const std::string& name = value.string();
  const std::vector<std::string> presets = transferPresets();
  if (std::find(presets.begin(), presets.end(), name) != presets.end()) return loadTransferFunction(name);
  const std::filesystem::path file = folder / name;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    std::string names;
    for (const std::string& preset : presets) names.append(names.empty() ? "" : ", ").append(preset);
    value.fail("expected a file or one of the presets " + names + ", found '" + file.string() + "'");
  }
  return parseTransferFunction(readTextFile(file), file.string());
}

void readLight(const JsonValue& value, const std::filesystem::path& folder, Scene& scene) {
  value.allowFields({"ambient", "background", "sources"});
  read(value, "ambient", scene.ambient);
  if (value.find("background")) read(value, "background", scene.background.emplace());
  if (const auto sources = value.find("sources"))
    for (const JsonValue& source : sources->items()) scene.lights.push_back(readLightSource(source, folder));
}

void readSampling(const JsonValue& value, SamplingOptions& sampling) {
  value.allowFields({"spacing", "unit", "quadrature", "segments", "bits", "saturation", "tableSize"});
  read(value, "spacing", sampling.spacing);
  read(value, "unit", kSpacingUnits, sampling.spacingInVoxels);
  read(value, "quadrature", kQuadratures, sampling.quadrature);
  read(value, "segments", sampling.segments);
  read(value, "bits", sampling.bits);
  read(value, "saturation", sampling.saturation);
}

void readOcclusion(const JsonValue& value, OcclusionOptions& occlusion) {
  value.allowFields(
      {"theta", "footprint", "passes", "algorithm", "perspectiveCorrection", "bits", "directions", "scale"});
  readDegrees(value, "theta", occlusion.aperture);
  read(value, "footprint", occlusion.footprint);
  read(value, "passes", occlusion.passes);
  read(value, "algorithm", occlusion.algorithm);
  read(value, "perspectiveCorrection", occlusion.perspectiveCorrection);
  read(value, "bits", occlusion.bits);
  read(value, "directions", occlusion.directions);
  read(value, "scale", occlusion.scale);
}

void readClip(const JsonValue& value, Scene& scene) {
  value.allowFields({"planes", "box"});
  if (const auto planes = value.find("planes"))
    for (const JsonValue& plane : planes->items()) {
      const std::vector<double> numbers = plane.numbers(4);
      scene.clipPlanes.emplace_back(numbers[0], numbers[1], numbers[2], numbers[3]);
    }
  if (const auto box = value.find("box")) {
    const std::vector<JsonValue> corners = box->items(2);
    const std::vector<double> low = corners[0].numbers(3), high = corners[1].numbers(3);
    Box& clip = scene.clipBox.emplace();
    clip.min = {low[0], low[1], low[2]};
    clip.max = {high[0], high[1], high[2]};
  }
}

void readBricks(const JsonValue& value, BrickSettings& bricks) {
  value.allowFields({"bricked", "interior", "culling", "format", "budgetMiB"});
  read(value, "bricked", bricks.bricked);
  read(value, "interior", bricks.interior);
  read(value, "culling", bricks.culling);
  read(value, "format", bricks.format);
  read(value, "budgetMiB", bricks.budgetMiB);
}

}  // namespace

Scene parseScene(std::string_view text, const std::string& source, const std::filesystem::path& folder) {
  const JsonDocument document(text, source);
  const JsonValue root = document.root();
  root.allowFields({"description", "volume", "camera", "transfer", "window", "sigmaScale", "model", "method", "light",
                    "sampling", "occlusion", "clip", "bricks"});
  Scene scene;
  std::string description;
  read(root, "description", description);
  if (const auto volume = root.find("volume")) readVolume(*volume, folder, scene.volume);
  if (const auto camera = root.find("camera")) readCamera(*camera, scene);
  if (const auto transfer = root.find("transfer")) scene.transfer = readTransfer(*transfer, folder);
  for (const char* key : {"window", "sigmaScale"})
    if (const auto value = root.find(key); value && !scene.transfer)
      value->fail("there is no 'transfer' to apply it to");
  if (const auto window = root.find("window")) scene.transfer = windowedBy(*scene.transfer, *window);
  if (const auto factor = root.find("sigmaScale")) scene.transfer = scaledBy(*scene.transfer, *factor);
  read(root, "model", kModels, scene.model);
  read(root, "method", kMethods, scene.method);
  if (const auto light = root.find("light")) readLight(*light, folder, scene);
  if (const auto sampling = root.find("sampling")) readSampling(*sampling, scene.sampling);
  if (const auto occlusion = root.find("occlusion")) readOcclusion(*occlusion, scene.occlusion);
  if (const auto clip = root.find("clip")) readClip(*clip, scene);
  if (const auto bricks = root.find("bricks")) readBricks(*bricks, scene.bricks);
  // Ranges are those of any scene; here they are reported where the text breaks them.
  if (const auto complaint = findComplaint(scene)) document.closest(complaint->field).fail(complaint->message);
  return scene;
}

Scene readScene(const std::filesystem::path& path) {
  return parseScene(readTextFile(path), path.string(), path.parent_path());
}

}  // namespace umbrick
