// SPDX-License-Identifier: Apache-2.0
#include "scene/field_json.h"

#include "core/json_writer.h"
#include "core/overload.h"
#include "scene/light_json.h"

namespace umbrick {
namespace {

std::string printedVector(const glm::dvec3& v) { return jsonNumbers({v.x, v.y, v.z}); }

}  // namespace

void readField(const JsonValue& value, const FieldPlace& place) {
  std::visit(Overload{[](std::monostate) {}, [&](double* target) { *target = value.number(); },
                      [&](const Angle& angle) { *angle.radians = value.degrees(); },
                      [&](int* target) { *target = value.integer(); },
                      [&](std::uint64_t* target) { *target = value.unsignedInteger(); },
                      [&](bool* target) { *target = value.boolean(); },
                      [&](const Choice& choice) { choice.set(value.oneOf(choice.names())); },
                      [&](glm::dvec2* target) {
                        const std::vector<double> numbers = value.numbers(2);
                        *target = {numbers[0], numbers[1]};
                      },
                      [&](glm::dvec3* target) { *target = readVector(value); },
                      [&](std::optional<glm::dvec3>* target) { *target = readVector(value); },
                      [&](const PixelSize& size) {
                        const std::vector<JsonValue> items = value.items(2);
                        *size.width = items[0].integer();
                        *size.height = items[1].integer();
                      }},
             place);
}

void readSurfaces(const JsonValue& value, Scene& scene) {
  scene.surfaces.clear();
  for (const JsonValue& item : value.items()) {
    item.allowFields({"value", "colour", "opacity"});
    SceneSurface& surface = scene.surfaces.emplace_back();
    surface.value = item.at("value").number();
    if (const auto colour = item.find("colour")) surface.colour = readVector(*colour);
    if (const auto opacity = item.find("opacity")) surface.opacity = opacity->number();
  }
}

void readClipPlanes(const JsonValue& value, Scene& scene) {
  scene.clipPlanes.clear();
  for (const JsonValue& plane : value.items()) {
    const std::vector<double> numbers = plane.numbers(4);
    scene.clipPlanes.emplace_back(numbers[0], numbers[1], numbers[2], numbers[3]);
  }
}

void readClipBox(const JsonValue& value, Scene& scene) {
  const std::vector<JsonValue> corners = value.items(2);
  const std::vector<double> low = corners[0].numbers(3), high = corners[1].numbers(3);
  Box& clip = scene.clipBox.emplace();
  clip.min = {low[0], low[1], low[2]};
  clip.max = {high[0], high[1], high[2]};
}

std::string printedSurfaces(const Scene& scene) {
  std::vector<std::string> surfaces;
  for (const SceneSurface& surface : scene.surfaces) {
    JsonFields fields{{"value", jsonNumber(surface.value)}};
    if (surface.colour) fields.emplace_back("colour", printedVector(*surface.colour));
    fields.emplace_back("opacity", jsonNumber(surface.opacity));
    surfaces.push_back(jsonObject(fields));
  }
  return jsonArray(surfaces);
}

std::string printedClipPlanes(const Scene& scene) {
  std::vector<std::string> planes;
  for (const ClipPlane& plane : scene.clipPlanes) planes.push_back(jsonNumbers({plane.x, plane.y, plane.z, plane.w}));
  return jsonArray(planes);
}

std::string printedClipBox(const Scene& scene) {
  return jsonArray({printedVector(scene.clipBox->min), printedVector(scene.clipBox->max)});
}

}  // namespace umbrick
