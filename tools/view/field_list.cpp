// SPDX-License-Identifier: Apache-2.0
#include "view/field_list.h"

#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include "core/overload.h"
#include "umbrick/scene/scene_fields.h"

namespace umbrick::view {
namespace {

using Json = nlohmann::ordered_json;

Json endOf(double number) { return std::isfinite(number) ? Json(number) : Json(); }

// A field that the scene of another camera has is listed with the first scene that has it.
FieldPlace placeOf(const SceneField& field, Scene& orbiting, Scene& placed) {
  const FieldPlace place = field.place(orbiting);
  return std::holds_alternative<std::monostate>(place) ? field.place(placed) : place;
}

std::pair<std::string, Json> kindOf(const FieldPlace& place) {
  using Kind = std::pair<std::string, Json>;
  return std::visit(Overload{[](std::monostate) {
                               return Kind{"text", Json()};
                             },
                             [](double*) {
                               return Kind{"number", Json()};
                             },
                             [](Angle) {
                               return Kind{"number", Json()};
                             },
                             [](int*) {
                               return Kind{"integer", Json()};
                             },
                             [](std::uint64_t*) {
                               return Kind{"integer", Json()};
                             },
                             [](bool*) {
                               return Kind{"flag", Json()};
                             },
                             [](const Choice& choice) {
                               return Kind{"choice", Json(choice.names())};
                             },
                             [](glm::dvec2*) {
                               return Kind{"vector", Json()};
                             },
                             [](glm::dvec3*) {
                               return Kind{"vector", Json()};
                             },
                             [](std::optional<glm::dvec3>*) {
                               return Kind{"colour", Json()};
                             },
                             [](PixelSize) {
                               return Kind{"size", Json()};
                             }},
                    place);
}

}  // namespace

Json fieldList() {
  Scene orbiting, placed;
  placed.orbit.reset();
  Json list = Json::array();
  for (const SceneField& field : sceneFields()) {
    const FieldPlace place = placeOf(field, orbiting, placed);
    auto [kind, choices] = kindOf(place);
    if (field.range.endsOnly) choices = {field.range.low, field.range.high};
    Json onlyOf = Json::array();
    for (const Method method : field.onlyOf) onlyOf.push_back(methodName(method));
    list.push_back({{"path", std::string(field.path)},
                    {"group", std::string(field.group)},
                    {"help", helpText(field)},
                    {"kind", kind},
                    {"choices", choices},
                    {"low", endOf(field.range.low)},
                    {"high", endOf(field.range.high)},
                    {"unit", std::holds_alternative<Angle>(place) ? "degrees" : ""},
                    {"multipleOf", field.range.multipleOf},
                    {"onlyOf", onlyOf},
                    {"default", defaultText(field)}});
  }
  return list;
}

}  // namespace umbrick::view
