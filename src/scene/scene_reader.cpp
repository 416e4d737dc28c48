// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>

#include "core/input_file.h"
#include "core/json_reader.h"
#include "core/text_file.h"
#include "scene/field_json.h"
#include "scene/key_tracks.h"
#include "scene/light_json.h"
#include "scene/scene_check.h"
#include "scene/scene_folder.h"
#include "umbrick/core/error.h"
#include "umbrick/mesh/mesh_file.h"
#include "umbrick/optics/transfer_json.h"
#include "umbrick/scene/scene_fields.h"

namespace umbrick {
namespace {

// Reads the fields of a section from its object.
// @param others  keys that the section may have besides
void readSection(const JsonValue& object, std::string_view section, Scene& scene,
                 std::vector<std::string_view> others = {}) {
  std::vector<std::string_view>& known = others;
  for (const SceneField& field : sceneFields())
    if (field.section() == section) known.push_back(field.key());
  const bool keyed = section != "sampling" && section != "bricks";
  if (keyed) known.insert(known.end(), {"keys", "curve"});
  object.allowFields(known);
  for (const SceneField& field : sceneFields())
    if (field.section() == section)
      if (const auto value = object.find(field.key())) readField(*value, field.place(scene));
  if (keyed) readKeys(object, section, scene);
}

RawLayout readRawLayout(const JsonValue& value) {
  value.allowFields({"dims", "type", "endian", "headerBytes", "bitsStored"});
  const auto whole = [](double number) { return number >= 0 && number < 0x1p53 && number == std::floor(number); };
  RawLayout raw;
  const std::vector<JsonValue> dims = value.at("dims").items(3);
  for (int axis = 0; axis < 3; ++axis)
    raw.dims[axis] = static_cast<std::int64_t>(dims[static_cast<std::size_t>(axis)].number(whole, "a whole number"));
  raw.type = value.at("type").string();
  if (const auto endian = value.find("endian")) raw.bigEndian = endian->oneOf({"little", "big"}) == "big";
  if (const auto header = value.find("headerBytes"))
    raw.headerBytes = static_cast<std::int64_t>(header->number(whole, "a whole number"));
  if (const auto bits = value.find("bitsStored")) raw.bitsStored = bits->integer();
  return raw;
}

void readVolume(const JsonValue& value, const SceneFolder& folder, VolumeReference& volume) {
  volume.besideOnly = folder.besideOnly();
  value.allowFields({"file", "grid", "emissionGrid", "series", "where", "raw", "spacing", "origin"});
  if (const auto file = value.find("file")) volume.file = folder.file(*file);
  if (const auto grid = value.find("grid")) volume.grid = grid->string();
  if (const auto emission = value.find("emissionGrid")) volume.emissionGrid = emission->string();
  if (const auto series = value.find("series")) volume.series = series->string();
  if (const auto where = value.find("where"))
    for (const JsonValue& condition : where->items()) volume.where.push_back(condition.string());
  if (const auto raw = value.find("raw")) volume.raw = readRawLayout(*raw);
  if (const auto spacing = value.find("spacing")) volume.spacing = readVector(*spacing);
  if (const auto origin = value.find("origin")) volume.origin = readVector(*origin);
}

// Reads the camera, which is placed by its eye or by angles around the volume.
void readCamera(const JsonValue& value, Scene& scene) {
  const auto keys = value.isObject() ? value.find("keys") : std::nullopt;
  const bool eyeAtKeys = keys && std::ranges::any_of(keys->items(), [](const JsonValue& key) {
                           return key.isObject() && key.find("eye");
                         });
  if (eyeAtKeys || (value.isObject() && value.find("eye"))) {
    for (const char* key : {"azimuth", "elevation", "upAxis", "frontAxis", "zoom", "pan"})
      if (const auto field = value.find(key)) field->fail("places the camera, but so does 'eye': give one of them");
    scene.orbit.reset();
  } else if (value.isObject()) {
    for (const char* key : {"lookAt", "up", "viewHeight"})
      if (const auto field = value.find(key))
        field->fail("needs 'eye': without it the camera is placed around the volume");
  }
  readSection(value, "camera", scene);
}

TransferFunction readTransfer(const JsonValue& value, const SceneFolder& folder) {
  if (!value.isString()) return readTransferFunction(value);
  const std::string& name = value.string();
  const std::vector<std::string> presets = transferPresets();
  if (std::find(presets.begin(), presets.end(), name) != presets.end()) return loadTransferFunction(name);
  const std::filesystem::path file = folder.file(value);
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    std::string names;
    for (const std::string& preset : presets) names.append(names.empty() ? "" : ", ").append(preset);
    value.fail("expected a file or one of the presets " + names + ", found '" + file.string() + "'");
  }
  return parseTransferFunction(readTextFile(file), file.string());
}

// Reads the transfer function, which may have keys.
void readMedium(const JsonValue& value, const SceneFolder& folder, Scene& scene) {
  if (value.isObject() && value.find("keys"))
    readTransferKeys(value, scene, [&](const JsonValue& function) { return readTransfer(function, folder); });
  else if (!value.isString() || value.string() != "auto")
    scene.transfer = readTransfer(value, folder);
}

// Applies to the transfer function, at all of its keys.
void applyToTransfer(Scene& scene, const std::function<TransferFunction(const TransferFunction&)>& change) {
  scene.transfer = change(*scene.transfer);
  for (SceneTrack& track : scene.tracks)
    for (SceneTrack::Key& key : track.keys)
      if (key.transfer) key.transfer = change(*key.transfer);
}

void readLight(const JsonValue& value, const SceneFolder& folder, Scene& scene) {
  readSection(value, "light", scene, {"sources"});
  if (const auto sources = value.find("sources"))
    for (const JsonValue& source : sources->items()) scene.lights.push_back(readLightSource(source, folder));
}

void readMeshOf(const JsonValue& value, const SceneFolder& folder, Scene& scene) {
  readSection(value, "mesh", scene, {"file"});
  const auto file = value.find("file");
  if (!file) return;
  scene.mesh.file = folder.file(*file);
  try {
    scene.mesh.shape = readMesh(scene.mesh.file);
  } catch (const IoError& error) {
    file->fail(error.what());
  }
}

void readEmission(const JsonValue& value, const SceneFolder& folder, Scene& scene) {
  readSection(value, "emission", scene, {"transfer"});
  if (const auto transfer = value.find("transfer")) scene.emission.table = readTransfer(*transfer, folder);
}

void readClip(const JsonValue& value, Scene& scene) {
  value.allowFields({"planes", "box", "keys", "curve"});
  if (const auto planes = value.find("planes")) readClipPlanes(*planes, scene);
  if (const auto box = value.find("box")) readClipBox(*box, scene);
  readKeys(value, "clip", scene);
}

}  // namespace

void readSceneField(const SceneField& field, std::string_view json, const std::string& source, Scene& scene) {
  const JsonDocument document(json, source);
  readField(document.root(), field.place(scene));
}

Scene parseScene(std::string_view text, const std::string& source, const std::filesystem::path& path, bool besideOnly) {
  const SceneFolder folder(path, besideOnly);
  const JsonDocument document(text, source);
  const JsonValue root = document.root();
  Scene scene;
  readSection(root, "", scene,
              {"description", "volume", "camera", "transfer", "window", "sigmaScale", "light", "sampling", "occlusion",
               "clip", "bricks", "surfaces", "mesh", "shading", "emission"});
  if (const auto description = root.find("description")) description->string();
  if (const auto volume = root.find("volume")) readVolume(*volume, folder, scene.volume);
  if (const auto camera = root.find("camera")) readCamera(*camera, scene);
  if (const auto transfer = root.find("transfer")) readMedium(*transfer, folder, scene);
  for (const char* key : {"window", "sigmaScale"})
    if (const auto value = root.find(key); value && !scene.transfer)
      value->fail("there is no 'transfer' to apply it to");
  if (const auto window = root.find("window"))
    applyToTransfer(scene, [&](const TransferFunction& transfer) { return windowedBy(transfer, *window); });
  if (const auto factor = root.find("sigmaScale"))
    applyToTransfer(scene, [&](const TransferFunction& transfer) { return scaledBy(transfer, *factor); });
  if (const auto light = root.find("light")) readLight(*light, folder, scene);
  // Scenes of earlier versions have the size of a table that no longer exists.
  if (const auto sampling = root.find("sampling")) readSection(*sampling, "sampling", scene, {"tableSize"});
  if (const auto occlusion = root.find("occlusion")) readSection(*occlusion, "occlusion", scene);
  if (const auto clip = root.find("clip")) readClip(*clip, scene);
  if (const auto surfaces = root.find("surfaces")) readSurfaces(*surfaces, scene);
  if (const auto mesh = root.find("mesh")) readMeshOf(*mesh, folder, scene);
  if (const auto shading = root.find("shading")) readSection(*shading, "shading", scene);
  if (const auto emission = root.find("emission")) readEmission(*emission, folder, scene);
  if (const auto bricks = root.find("bricks")) readSection(*bricks, "bricks", scene);
  // What has keys is shown as it is at frame 0, where a picture is of no frame.
  scene = sceneAt(scene, 0);
  // The ranges are those of any scene; here they are reported at the place in the text that breaks them.
  if (const auto complaint = findComplaintAtKeys(scene)) document.closest(complaint->field).fail(complaint->message);
  if (const auto complaint = findComplaint(scene)) document.closest(complaint->field).fail(complaint->message);
  return scene;
}

Scene readScene(const std::filesystem::path& path, bool besideOnly) {
  const std::string text = readTextFile(path);
  if (besideOnly) requireBeside(path, path);
  return parseScene(text, path.string(), path.parent_path(), besideOnly);
}

}  // namespace umbrick
