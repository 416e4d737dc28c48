#include "scene/light_json.h"

#include "core/json_writer.h"
#include "scene/names.h"

namespace umbrick {
namespace {

enum class LightType { cone, directional, directions };
constexpr Name<LightType> kLightTypes[]{
    {"cone", LightType::cone}, {"directional", LightType::directional}, {"directions", LightType::directions}};
constexpr Name<LightFrame> kLightFrames[]{{"view", LightFrame::view}, {"world", LightFrame::world}};

glm::dvec3 vectorOf(const JsonValue& value) {
  const std::vector<double> numbers = value.numbers(3);
  return {numbers[0], numbers[1], numbers[2]};
}
// Three numbers, or one for all.
glm::dvec3 radianceOf(const JsonValue& value) { return value.isArray() ? vectorOf(value) : glm::dvec3(value.number()); }

ConeLight readCone(const JsonValue& value, std::string_view axis, std::string_view angle, bool sharp) {
  value.allowFields({"type", "frame", axis, angle, "radiance"});
  ConeLight cone;
  cone.axis = vectorOf(value.at(axis));
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
    listed.direction = vectorOf(item.at("direction"));
    if (const auto weight = item.find("weight")) listed.weight = weight->number();
    if (const auto colour = item.find("colour")) listed.colour = radianceOf(*colour);
  }
  return light;
}

std::string printed(const glm::dvec3& v) { return jsonNumbers({v.x, v.y, v.z}); }

JsonFields fieldsOf(const ConeLight& cone) {
  return {{"type", jsonString("cone")},
          {"axis", printed(cone.axis)},
          {"theta", jsonDegrees(cone.aperture)},
          {"radiance", printed(cone.radiance)}};
}

JsonFields fieldsOf(const ListedLight& light) {
  std::vector<std::string> list;
  for (const ListedDirection& listed : light.list)
    list.push_back(jsonObject({{"direction", printed(listed.direction)},
                               {"weight", jsonNumber(listed.weight)},
                               {"colour", printed(listed.colour)}}));
  return {{"type", jsonString("directions")}, {"list", jsonArray(list)}};
}

}  // namespace

LightSource readLightSource(const JsonValue& value, const std::filesystem::path&) {
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
  }
  return source;
}

std::string printLightSource(const LightSource& source) {
  JsonFields fields = std::visit([](const auto& light) { return fieldsOf(light); }, source.light);
  fields.emplace(fields.begin() + 1, "frame", jsonString(std::string(nameOf(kLightFrames, source.frame))));
  return jsonObject(fields);
}

}  // namespace umbrick
