// SPDX-License-Identifier: Apache-2.0
#include "scene/light_json.h"

#include "core/json_writer.h"
#include "scene/scene_folder.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

enum class LightType { cone, directional, directions, environment };
constexpr Name<LightType> kLightTypes[]{{"cone", LightType::cone},
                                        {"directional", LightType::directional},
                                        {"directions", LightType::directions},
                                        {"environment", LightType::environment}};

// Reads three numbers, or one for all three.
glm::dvec3 radianceOf(const JsonValue& value) {
  return value.isArray() ? readVector(value) : glm::dvec3(value.number());
}

ConeLight readCone(const JsonValue& value, std::string_view axis, std::string_view angle, bool sharp) {
  value.allowFields({"type", "frame", axis, angle, "radiance"});
  ConeLight cone;
  cone.axis = readVector(value.at(axis));
  if (!sharp || value.find(angle)) cone.aperture = value.at(angle).degrees();
  if (const auto radiance = value.find("radiance")) cone.radiance = radianceOf(*radiance);
  return cone;
}

ListedLight readListed(const JsonValue& value) {
  value.allowFields({"type", "frame", "list"});
  ListedLight light;
  for (const JsonValue& item : value.at("list").items()) {
    item.allowFields({"direction", "weight", "colour"});
    ListedDirection& listed = light.list.emplace_back();
    listed.direction = readVector(item.at("direction"));
    if (const auto weight = item.find("weight")) listed.weight = weight->number();
    if (const auto colour = item.find("colour")) listed.colour = radianceOf(*colour);
  }
  return light;
}

EnvironmentLight readEnvironment(const JsonValue& value, LightFrame frame, const SceneFolder& folder) {
  value.allowFields({"type", "frame", "file", "up", "front", "scale"});
  const JsonValue file = value.at("file");
  const std::filesystem::path path = folder.file(file);
  EnvironmentLight light;
  try {
    light = loadEnvironment(path);
  } catch (const IoError& error) {
    file.fail(error.what());
  }
  // The axes are those of the camera of azimuth 0 and elevation 0, where both frames agree.
  if (frame == LightFrame::world) {
    light.up = {0, 0, 1};
    light.front = {0, -1, 0};
  }
  if (const auto up = value.find("up")) light.up = readVector(*up);
  if (const auto front = value.find("front")) light.front = readVector(*front);
  if (const auto scale = value.find("scale")) light.scale = scale->number();
  return light;
}

std::string printedLightValue(const glm::dvec3& v) { return jsonNumbers({v.x, v.y, v.z}); }

JsonFields fieldsOf(const ConeLight& cone) {
  return {{"type", jsonString("cone")},
          {"axis", printedLightValue(cone.axis)},
          {"theta", jsonDegrees(cone.aperture)},
          {"radiance", printedLightValue(cone.radiance)}};
}

JsonFields fieldsOf(const ListedLight& light) {
  std::vector<std::string> list;
  for (const ListedDirection& listed : light.list)
    list.push_back(jsonObject({{"direction", printedLightValue(listed.direction)},
                               {"weight", jsonNumber(listed.weight)},
                               {"colour", printedLightValue(listed.colour)}}));
  return {{"type", jsonString("directions")}, {"list", jsonArray(list)}};
}

JsonFields fieldsOf(const EnvironmentLight& light) {
  if (light.file.empty())
    throw InvalidArgument("light.sources: an environment map that is no file has no place in JSON");
  return {{"type", jsonString("environment")},
          {"file", jsonString(light.file.string())},
          {"up", printedLightValue(light.up)},
          {"front", printedLightValue(light.front)},
          {"scale", jsonNumber(light.scale)}};
}

}  // namespace

glm::dvec3 readVector(const JsonValue& value) {
  const std::vector<double> numbers = value.numbers(3);
  return {numbers[0], numbers[1], numbers[2]};
}

LightSource readLightSource(const JsonValue& value, const SceneFolder& folder) {
  LightSource source;
  if (const auto frame = value.find("frame")) source.frame = frame->choice<LightFrame>(kLightFrames);
  switch (value.at("type").choice<LightType>(kLightTypes)) {
    case LightType::cone:
      source.light = readCone(value, "axis", "theta", false);
      break;
    case LightType::directional:
      source.light = readCone(value, "direction", "softAngle", true);
      break;
    case LightType::directions:
      source.light = readListed(value);
      break;
    case LightType::environment:
      source.light = readEnvironment(value, source.frame, folder);
      break;
  }
  return source;
}

std::string printLightSource(const LightSource& source) {
  JsonFields fields = std::visit([](const auto& light) { return fieldsOf(light); }, source.light);
  fields.emplace(fields.begin() + 1, "frame", jsonString(std::string(nameOf(kLightFrames, source.frame))));
  return jsonObject(fields);
}

}  // namespace umbrick
