// SPDX-License-Identifier: Apache-2.0
#include "scene/field_text.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/json_writer.h"
#include "core/overload.h"
#include "scene/checker.h"

namespace umbrick {
namespace {

std::string spaced(const glm::dvec3& v) { return jsonNumber(v.x) + ' ' + jsonNumber(v.y) + ' ' + jsonNumber(v.z); }
std::string spaced(const glm::dvec2& v) { return jsonNumber(v.x) + ' ' + jsonNumber(v.y); }
std::string jsonVector(const glm::dvec3& v) { return jsonNumbers({v.x, v.y, v.z}); }

bool within(double value, const FieldRange& range, double unit = 1) {
  if (range.orElse && value == *range.orElse) return true;
  const double low = range.low * unit, high = range.high * unit;
  if (!std::isfinite(value) || value < low || value > high) return false;
  if ((range.lowOpen && value == low) || (range.highOpen && value == high)) return false;
  if (range.endsOnly && value != low && value != high) return false;
  return range.multipleOf == 1 || std::fmod(value, range.multipleOf) == 0;
}

// Scenes that together have all fields.
class Defaults {
 public:
  Defaults() { placed_.orbit.reset(); }
  FieldPlace place(const SceneField& field) {
    const FieldPlace orbited = field.place(orbited_);
    return std::holds_alternative<std::monostate>(orbited) ? field.place(placed_) : orbited;
  }

 private:
  Scene orbited_, placed_;
};

std::string limitText(double limit) {
  int exponent = 0;
  const bool powerOfTwo = std::frexp(limit, &exponent) == 0.5;
  return powerOfTwo && exponent > 20 ? "2^" + std::to_string(exponent - 1) : jsonNumber(limit);
}

std::string vectorRange(std::string_view count, const FieldRange& range) {
  return std::string(count) + " finite numbers" + (range.low == 0 ? " of 0 or more" : "");
}

std::string realRange(const FieldRange& range) {
  if (std::isfinite(range.low) && std::isfinite(range.high))
    return std::string("in ") + (range.lowOpen ? '(' : '[') + limitText(range.low) + ", " + limitText(range.high) +
           (range.highOpen ? ')' : ']');
  if (!std::isfinite(range.low)) return "finite";
  return range.lowOpen ? "above " + limitText(range.low) : limitText(range.low) + " or more";
}

std::string wholeRange(const FieldRange& range) {
  const std::string low = limitText(range.low), high = limitText(range.high);
  std::string text = range.endsOnly ? low + " or " + high
                     : range.multipleOf > 1
                         ? "a multiple of " + std::to_string(range.multipleOf) + " from " + low + " to " + high
                         : low + " to " + high;
  if (range.orElse) text += ", or " + limitText(*range.orElse) + " to have it chosen";
  return text;
}

}  // namespace

std::string jsonText(const FieldPlace& place) {
  return std::visit(
      Overload{[](std::monostate) { return std::string(); }, [](const double* value) { return jsonNumber(*value); },
               [](const Angle& angle) { return jsonDegrees(*angle.radians); },
               [](const int* value) { return std::to_string(*value); },
               [](const std::uint64_t* value) { return std::to_string(*value); },
               [](const bool* value) { return std::string(*value ? "true" : "false"); },
               [](const Choice& choice) { return jsonString(std::string(choice.get())); },
               [](const glm::dvec2* value) {
                 return jsonNumbers({value->x, value->y});
               },
               [](const glm::dvec3* value) { return jsonVector(*value); },
               [](const std::optional<glm::dvec3>* value) { return *value ? jsonVector(**value) : std::string(); },
               [](const PixelSize& size) {
                 return jsonArray({std::to_string(*size.width), std::to_string(*size.height)});
               }},
      place);
}

std::string messageText(const FieldPlace& place) {
  return std::visit(
      Overload{[](double* value) { return print(*value); },
               [](const Angle& angle) { return printDegrees(*angle.radians); },
               [](const Choice& choice) { return "'" + std::string(choice.get()) + "'"; },
               [](glm::dvec2* value) { return "(" + print(value->x) + " " + print(value->y) + ")"; },
               [](glm::dvec3* value) { return print(*value); },
               [](std::optional<glm::dvec3>* value) { return *value ? print(**value) : std::string("none"); },
               [](const PixelSize& size) { return std::to_string(*size.width) + " x " + std::to_string(*size.height); },
               [&](const auto&) { return jsonText(place); }},
      place);
}

bool inRange(const FieldPlace& place, const FieldRange& range) {
  const auto vector = [&](const glm::dvec3& v) {
    return within(v.x, range) && within(v.y, range) && within(v.z, range);
  };
  return std::visit(
      Overload{[](std::monostate) { return true; }, [](const bool*) { return true; },
               [&](const double* value) { return within(*value, range); },
               [&](const Angle& angle) { return within(*angle.radians, range, std::numbers::pi / 180); },
               [&](const int* value) { return within(*value, range); },
               [&](const std::uint64_t* value) { return within(static_cast<double>(*value), range); },
               [](const Choice& choice) { return !choice.get().empty(); },
               [&](const glm::dvec2* value) { return within(value->x, range) && within(value->y, range); },
               [&](const glm::dvec3* value) { return vector(*value); },
               [&](const std::optional<glm::dvec3>* value) { return !*value || vector(**value); },
               [&](const PixelSize& size) { return within(*size.width, range) && within(*size.height, range); }},
      place);
}

std::string rangeText(const SceneField& field) {
  Defaults defaults;
  const FieldPlace place = defaults.place(field);
  const FieldRange& range = field.range;
  return std::visit(
      Overload{[](std::monostate) { return std::string(); }, [](const bool*) { return std::string(); },
               [&](const double*) { return realRange(range); }, [&](const Angle&) { return realRange(range); },
               [&](const int*) { return wholeRange(range); }, [&](const std::uint64_t*) { return wholeRange(range); },
               [](const Choice& choice) { return "one of " + joined(choice.names()); },
               [&](const glm::dvec2*) { return vectorRange("two", range); },
               [&](const glm::dvec3*) { return vectorRange("three", range); },
               [&](const std::optional<glm::dvec3>*) { return vectorRange("three", range); },
               [&](const PixelSize&) { return "at least " + limitText(range.low) + " x " + limitText(range.low); }},
      place);
}

std::string defaultText(const SceneField& field) {
  Defaults defaults;
  const FieldPlace place = defaults.place(field);
  return std::visit(
      Overload{[](bool*) { return std::string(); }, [](const Choice& choice) { return std::string(choice.get()); },
               [](glm::dvec2* value) { return spaced(*value); }, [](glm::dvec3* value) { return spaced(*value); },
               [](std::optional<glm::dvec3>* value) { return *value ? spaced(**value) : std::string("none"); },
               [](const PixelSize& size) { return std::to_string(*size.width) + "x" + std::to_string(*size.height); },
               [&](const auto&) { return jsonText(place); }},
      place);
}

std::string helpText(const SceneField& field) {
  Scene scene;
  const FieldPlace place = field.place(scene);
  std::string text(field.help);
  // The help lists names itself, and vectors and sizes need no range; of numbers, only those that can be
  // wrong need one.
  const bool whole = std::holds_alternative<int*>(place) && !field.range.endsOnly;
  const bool bounded = std::isfinite(field.range.low) && std::isfinite(field.range.high);
  if (whole || (bounded && (std::holds_alternative<double*>(place) || std::holds_alternative<Angle>(place))))
    text += ", " + rangeText(field);
  // A field that scenes have only sometimes has no default except what `otherwise` says.
  const std::string usual = std::holds_alternative<std::monostate>(place) ? std::string() : defaultText(field);
  const std::string shown = usual + std::string(field.otherwise);
  return shown.empty() ? text : text + " [" + shown + "]";
}

}  // namespace umbrick
