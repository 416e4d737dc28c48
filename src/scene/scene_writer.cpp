// SPDX-License-Identifier: Apache-2.0
#include "core/json_writer.h"
#include "scene/field_json.h"
#include "scene/field_text.h"
#include "scene/key_tracks.h"
#include "scene/light_json.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

std::string printed(const glm::dvec3& v) { return jsonNumbers({v.x, v.y, v.z}); }
// Returns those fields of a section that the scene has.
JsonFields printedFields(std::string_view section, Scene& scene) {
  JsonFields fields;
  for (const SceneField& field : sceneFields()) {
    if (field.section() != section) continue;
    const std::string text = jsonText(field.place(scene));
    if (!text.empty()) fields.emplace_back(field.key(), text);
  }
  for (const auto& field : printedKeys(section, scene)) fields.push_back(field);
  return fields;
}

std::string printedRaw(const RawLayout& raw) {
  JsonFields fields{
      {"dims", jsonArray({std::to_string(raw.dims.x), std::to_string(raw.dims.y), std::to_string(raw.dims.z)})},
      {"type", jsonString(raw.type)},
      {"endian", jsonString(raw.bigEndian ? "big" : "little")}};
  if (raw.headerBytes != 0) fields.emplace_back("headerBytes", std::to_string(raw.headerBytes));
  if (raw.bitsStored) fields.emplace_back("bitsStored", std::to_string(*raw.bitsStored));
  return jsonObject(fields);
}

std::string printedVolume(const VolumeReference& volume) {
  JsonFields fields{{"file", jsonString(volume.file.string())}};
  if (!volume.grid.empty()) fields.emplace_back("grid", jsonString(volume.grid));
  if (!volume.emissionGrid.empty()) fields.emplace_back("emissionGrid", jsonString(volume.emissionGrid));
  if (!volume.series.empty()) fields.emplace_back("series", jsonString(volume.series));
  std::vector<std::string> where;
  for (const std::string& condition : volume.where) where.push_back(jsonString(condition));
  if (!where.empty()) fields.emplace_back("where", jsonArray(where));
  if (volume.raw) fields.emplace_back("raw", printedRaw(*volume.raw));
  if (volume.spacing) fields.emplace_back("spacing", printed(*volume.spacing));
  if (volume.origin) fields.emplace_back("origin", printed(*volume.origin));
  return jsonObject(fields);
}

std::string printedLight(Scene& scene) {
  JsonFields fields = printedFields("light", scene);
  std::vector<std::string> sources;
  for (const LightSource& source : scene.lights) sources.push_back(printLightSource(source));
  if (!sources.empty()) fields.emplace_back("sources", jsonArray(sources));
  return jsonObject(fields);
}

std::string printedMesh(Scene& scene) {
  JsonFields fields;
  if (scene.mesh.shape) {
    if (scene.mesh.file.empty()) throw InvalidArgument("mesh: one that comes from no file has no place in JSON");
    fields.emplace_back("file", jsonString(scene.mesh.file.string()));
  }
  for (const auto& field : printedFields("mesh", scene)) fields.push_back(field);
  return jsonObject(fields);
}

std::string printedEmission(Scene& scene) {
  JsonFields fields = printedFields("emission", scene);
  if (scene.emission.table) fields.emplace_back("transfer", printTransferFunction(*scene.emission.table));
  return jsonObject(fields);
}

std::string printedClip(const Scene& scene) {
  JsonFields fields;
  if (!scene.clipPlanes.empty()) fields.emplace_back("planes", printedClipPlanes(scene));
  if (scene.clipBox) fields.emplace_back("box", printedClipBox(scene));
  for (const auto& field : printedKeys("clip", scene)) fields.push_back(field);
  return jsonObject(fields);
}

std::string printedTransfer(const Scene& scene) {
  const JsonFields keys = printedKeys("transfer", scene);
  return keys.empty() ? printTransferFunction(*scene.transfer) : jsonObject(keys);
}

}  // namespace

std::string printScene(const Scene& given) {
  Scene scene = given;  // a copy, since a field's place is that of a scene that may be changed
  JsonFields fields;
  if (scene.volume != VolumeReference{}) fields.emplace_back("volume", printedVolume(scene.volume));
  fields.emplace_back("camera", jsonObject(printedFields("camera", scene)));
  if (scene.transfer) fields.emplace_back("transfer", printedTransfer(scene));
  for (const auto& field : printedFields("", scene)) fields.push_back(field);
  if (!scene.surfaces.empty()) fields.emplace_back("surfaces", printedSurfaces(scene));
  if (scene.mesh != SceneMesh{} || !printedKeys("mesh", scene).empty()) fields.emplace_back("mesh", printedMesh(scene));
  if (scene.shading != ShadingOptions{} || !printedKeys("shading", scene).empty())
    fields.emplace_back("shading", jsonObject(printedFields("shading", scene)));
  if (scene.emission != EmissionSettings{} || !printedKeys("emission", scene).empty())
    fields.emplace_back("emission", printedEmission(scene));
  fields.emplace_back("light", printedLight(scene));
  fields.emplace_back("sampling", jsonObject(printedFields("sampling", scene)));
  fields.emplace_back("occlusion", jsonObject(printedFields("occlusion", scene)));
  if (!scene.clipPlanes.empty() || scene.clipBox || !printedKeys("clip", scene).empty())
    fields.emplace_back("clip", printedClip(scene));
  fields.emplace_back("bricks", jsonObject(printedFields("bricks", scene)));
  return jsonObject(fields);
}

}  // namespace umbrick
