// Tests what must hold for every row of the table of a scene's fields, whatever rows there are.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/scene/scene_fields.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "scene/field_text.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRadians = std::numbers::pi / 180;

template <class... Handlers>
struct Overload : Handlers... {
  using Handlers::operator()...;
};

Scene parsedScene(const std::string& text) { return parseScene(text, "s.json"); }

// Returns the default scene, with its camera placed by its eye where only such a scene has the field.
Scene sceneOf(const SceneField& field) {
  Scene scene;
  if (std::holds_alternative<std::monostate>(field.place(scene))) scene.orbit.reset();
  REQUIRE_FALSE(std::holds_alternative<std::monostate>(field.place(scene)));
  return scene;
}

// Returns a number in a range that has a lower end; another `share` of the way from 0 to 1 is another number.
double inside(const FieldRange& range, double share) {
  const double low = range.low;
  const double high = std::isfinite(range.high) ? range.high : low + 20;
  return low + (high - low) * share;
}

// Returns a whole number in the range that is not the present one.
double wholeInside(const FieldRange& range, double present) {
  if (range.endsOnly) return present == range.low ? range.high : range.low;
  const double next = range.low + range.multipleOf;
  return next == present ? next + range.multipleOf : next;
}

// Gives a field a valid value that it does not have now.
void change(const SceneField& field, Scene& scene) {
  const FieldRange& range = field.range;
  const auto number = [&](double present, double share) {
    if (!std::isfinite(range.low)) return present + 10 * share;
    const double other = inside(range, share);
    return other == present ? inside(range, 0.9 * share) : other;
  };
  const auto vector = [&](const glm::dvec3& v) {
    return glm::dvec3(number(v.x, 0.31), number(v.y, 0.47), number(v.z, 0.73));
  };
  std::visit(Overload{[](std::monostate) {}, [&](double* value) { *value = number(*value, 0.37); },
                      [&](const Angle& angle) { *angle.radians = kRadians * number(*angle.radians / kRadians, 0.37); },
                      [&](int* value) { *value = static_cast<int>(wholeInside(range, *value)); },
                      [&](std::uint64_t* value) {
                        *value = static_cast<std::uint64_t>(wholeInside(range, static_cast<double>(*value)));
                      },
                      [](bool* value) { *value = !*value; },
                      [](const Choice& choice) {
                        const std::vector<std::string> names = choice.names();
                        const auto other = std::find_if(names.begin(), names.end(),
                                                        [&](const std::string& name) { return name != choice.get(); });
                        REQUIRE(other != names.end());
                        REQUIRE(choice.set(*other));
                      },
                      [&](glm::dvec2* value) {
                        *value = {number(value->x, 0.31), number(value->y, 0.47)};
                      },
                      [&](glm::dvec3* value) { *value = vector(*value); },
                      [&](std::optional<glm::dvec3>* value) { *value = vector(value->value_or(glm::dvec3(0))); },
                      [&](const PixelSize& size) {
                        *size.width = static_cast<int>(wholeInside(range, *size.width));
                        *size.height = static_cast<int>(wholeInside(range, *size.height)) + 5;
                      }},
             field.place(scene));
}

bool isReal(const FieldPlace& place) {
  return std::holds_alternative<double*>(place) || std::holds_alternative<Angle>(place) ||
         std::holds_alternative<glm::dvec2*>(place) || std::holds_alternative<glm::dvec3*>(place) ||
         std::holds_alternative<std::optional<glm::dvec3>*>(place);
}

bool isWhole(const FieldPlace& place) {
  return std::holds_alternative<int*>(place) || std::holds_alternative<std::uint64_t*>(place) ||
         std::holds_alternative<PixelSize>(place);
}

// Returns how many numbers a field has: one, or one for each component.
int numbersOf(const FieldPlace& place) {
  if (std::holds_alternative<PixelSize>(place) || std::holds_alternative<glm::dvec2*>(place)) return 2;
  return std::holds_alternative<glm::dvec3*>(place) || std::holds_alternative<std::optional<glm::dvec3>*>(place) ? 3
                                                                                                                 : 1;
}

// Sets one of a field's numbers, in its unit in memory, to a value that may be invalid.
void setNumber(const FieldPlace& place, int component, double number) {
  std::visit(
      Overload{[&](double* value) { *value = number; }, [&](const Angle& angle) { *angle.radians = number; },
               [&](int* value) { *value = static_cast<int>(number); },
               [&](std::uint64_t* value) { *value = static_cast<std::uint64_t>(number); },
               [&](glm::dvec2* value) { (*value)[component] = number; },
               [&](glm::dvec3* value) { (*value)[component] = number; },
               [&](std::optional<glm::dvec3>* value) {
                 if (!*value) value->emplace(0.5);
                 (**value)[component] = number;
               },
               [&](const PixelSize& size) { *(component == 0 ? size.width : size.height) = static_cast<int>(number); },
               [](const auto&) { FAIL("has no numbers"); }},
      place);
}

// Numbers at and near the ends of a range, in the unit in memory.
struct Ends {
  std::vector<double> refused, accepted;
};

Ends endsOf(const FieldPlace& place, const FieldRange& range) {
  Ends ends;
  if (isWhole(place)) {
    for (const auto& [end, outwards] : {std::pair(range.low, -1), std::pair(range.high, 1)})
      if (std::isfinite(end)) {
        ends.accepted.push_back(end);
        ends.refused.push_back(end + outwards);
        if (range.multipleOf > 1 || (range.endsOnly && range.high - range.low > 1))
          ends.refused.push_back(end - outwards);
      }
    if (range.orElse) ends.accepted.push_back(*range.orElse);
    return ends;
  }
  const double unit = std::holds_alternative<Angle>(place) ? kRadians : 1;
  for (const auto& [end, open, outwards] : {std::tuple(unit * range.low, range.lowOpen, -kInfinity),
                                            std::tuple(unit * range.high, range.highOpen, kInfinity)})
    if (std::isfinite(end)) {
      ends.accepted.push_back(open ? std::nextafter(end, -outwards) : end);
      ends.refused.push_back(open ? end : std::nextafter(end, outwards));
    }
  for (const double number : {kInfinity, -kInfinity, std::nan("")}) ends.refused.push_back(number);
  return ends;
}

void forEachNumber(const std::function<void(const SceneField&, int component)>& action) {
  for (const SceneField& field : sceneFields()) {
    Scene scene = sceneOf(field);
    const FieldPlace place = field.place(scene);
    if (!isReal(place) && !isWhole(place)) continue;
    for (int component = 0; component < numbersOf(place); ++component) action(field, component);
  }
}

std::string quoted(std::string_view text) { return '"' + std::string(text) + '"'; }

}  // namespace

TEST_CASE("Every field has a path and an option of its own, by which it is found", "[scene]") {
  std::set<std::string_view> paths, options;
  for (const SceneField& field : sceneFields()) {
    CAPTURE(field.path);
    CHECK(paths.insert(field.path).second);
    CHECK(findSceneField(field.path) == &field);
    CHECK(field.path == (field.section().empty() ? "" : std::string(field.section()) + ".") + std::string(field.key()));
    CHECK_FALSE(field.key().empty());
    CHECK_FALSE(field.group.empty());
    CHECK_FALSE(field.help.empty());
    if (field.option.empty()) continue;
    CHECK(options.insert(field.option).second);
    CHECK(findSceneField(field.option) == &field);
  }
  CHECK(findSceneField("occlusion.footprint")->option == "footprint");
  CHECK(findSceneField("nothing") == nullptr);
  CHECK(findSceneField("") == nullptr);
}

TEST_CASE("A scene with every field changed parses back to an equal one", "[scene]") {
  for (const bool orbit : {true, false}) {
    Scene scene;
    if (!orbit) scene.orbit.reset();
    const Scene before = scene;
    for (const SceneField& field : sceneFields()) change(field, scene);
    if (orbit) scene.orbit->front = Axis::minusY;  // the same axis cannot be up, too
    validateScene(scene);
    CHECK_FALSE(scene == before);
    CHECK(parsedScene(printScene(scene)) == scene);
  }
}

// This test would show two rows with the place of one member, and a row that the reader or the writer leaves out.
TEST_CASE("A field that is changed alone changes no other, and is read from a text with nothing else", "[scene]") {
  for (const SceneField& field : sceneFields()) {
    CAPTURE(field.path);
    Scene scene = sceneOf(field);
    Scene before = scene;
    change(field, scene);
    validateScene(scene);
    CHECK_FALSE(scene == before);
    CHECK(parsedScene(printScene(scene)) == scene);
    for (const SceneField& other : sceneFields()) {
      CAPTURE(other.path);
      CHECK((jsonText(other.place(scene)) == jsonText(other.place(before))) == (&other != &field));
    }
    std::string text = quoted(field.key()) + ": " + jsonText(field.place(scene));
    if (!scene.orbit && field.key() != "eye") text += ", \"eye\": " + jsonText(&scene.camera.eye);
    if (!field.section().empty()) text = quoted(field.section()) + ": {" + text + "}";
    CHECK(parsedScene("{" + text + "}") == scene);
  }
}

TEST_CASE("Every name of a choice is read, printed and kept apart from the others", "[scene]") {
  for (const SceneField& field : sceneFields()) {
    CAPTURE(field.path);
    Scene scene = sceneOf(field);
    scene.lights = {{LightFrame::view, ConeLight{{0, 0, 1}, 0.1, glm::dvec3(1)}}};  // a model needs a light
    const FieldPlace place = field.place(scene);
    const Choice* choice = std::get_if<Choice>(&place);
    if (choice == nullptr) continue;
    const std::vector<std::string> names = choice->names();
    CHECK(std::set<std::string>(names.begin(), names.end()).size() == names.size());
    for (const std::string& name : names) {
      CAPTURE(name);
      CHECK(choice->set(name));
      CHECK(choice->get() == name);
      CHECK(parsedScene(printScene(scene)) == scene);
      CHECK_THAT(std::string(field.help), Contains(name));
    }
    const Scene before = scene;
    CHECK_FALSE(choice->set("nothing"));
    CHECK(scene == before);
    CHECK_THAT(rangeText(field), StartsWith("one of " + names.front()) && EndsWith(names.back()));
  }
}

TEST_CASE("Numbers just outside their range are refused by the name of their field", "[scene]") {
  forEachNumber([](const SceneField& field, int component) {
    Scene scene = sceneOf(field);
    for (const double number : endsOf(field.place(scene), field.range).refused) {
      CAPTURE(field.path, component, number);
      setNumber(field.place(scene), component, number);
      const std::string complaint = std::string(field.path) + ": is ", range = "must be " + rangeText(field);
      CHECK_THROWS_WITH(validateScene(scene), StartsWith(complaint) && EndsWith(range));
      // A text with such a number is refused in the same words, after the place in the text.
      if (!std::isfinite(number)) continue;
      CHECK_THROWS_WITH(parsedScene(printScene(scene)),
                        StartsWith("s.json:") && Contains(": " + complaint) && EndsWith(range));
    }
  });
}

TEST_CASE("Numbers at the ends of their range are accepted, or next to ends that are excluded", "[scene]") {
  forEachNumber([](const SceneField& field, int component) {
    Scene scene = sceneOf(field);
    for (const double number : endsOf(field.place(scene), field.range).accepted) {
      CAPTURE(field.path, component, number);
      setNumber(field.place(scene), component, number);
      CHECK_NOTHROW(validateScene(scene));
      CHECK(parsedScene(printScene(scene)) == scene);
    }
  });
}

TEST_CASE("The help of a field tells its default", "[scene]") {
  for (const SceneField& field : sceneFields()) {
    CAPTURE(field.path);
    Scene scene = sceneOf(field);
    const std::string text = defaultText(field);
    CHECK_THAT(helpText(field), StartsWith(std::string(field.help)));
    // A field that scenes have only sometimes, for example an eye, has no default except what its row says.
    Scene usual;
    const bool always = !std::holds_alternative<std::monostate>(field.place(usual));
    const std::string shown = (always ? text : std::string()) + std::string(field.otherwise);
    if (!shown.empty()) CHECK_THAT(helpText(field), EndsWith("[" + shown + "]"));
    std::istringstream stream(text);
    const auto number = [&] {
      double read = std::nan("");
      stream >> read;
      return read;
    };
    const auto vector = [&] {
      const double x = number(), y = number();
      return glm::dvec3(x, y, number());
    };
    std::visit(
        Overload{[](std::monostate) {}, [&](double* value) { CHECK(number() == *value); },
                 [&](const Angle& angle) { CHECK(number() * kRadians == Approx(*angle.radians).epsilon(1e-15)); },
                 [&](int* value) { CHECK(number() == *value); },
                 [&](std::uint64_t* value) { CHECK(number() == static_cast<double>(*value)); },
                 // The option of a boolean only turns it to the opposite, so that no default is told.
                 [&](bool*) { CHECK(helpText(field) == field.help); },
                 [&](const Choice& choice) { CHECK(text == choice.get()); },
                 [&](glm::dvec2* value) {
                   const double x = number();
                   CHECK(glm::dvec2(x, number()) == *value);
                 },
                 [&](glm::dvec3* value) { CHECK(vector() == *value); },
                 [&](std::optional<glm::dvec3>* value) { CHECK((*value ? *value == vector() : text == "none")); },
                 [&](const PixelSize& size) {
                   CHECK(text == std::to_string(*size.width) + "x" + std::to_string(*size.height));
                 }},
        field.place(scene));
  }
  CHECK(helpText(*findSceneField("footprint")) == "of dos, n: n x n samples over the cone's footprint, 1 to 16 [3]");
  CHECK(helpText(*findSceneField("theta")) == "half-angle of the cone, degrees, in [0, 90) [60]");
  CHECK_THAT(helpText(*findSceneField("ambient")), EndsWith("[1 1 1]"));
  CHECK_THAT(helpText(*findSceneField("background")), EndsWith("[none]"));
  CHECK_THAT(helpText(*findSceneField("size")), EndsWith("[512x512]"));
}

TEST_CASE("A range reads as a user would say it", "[scene]") {
  const std::pair<const char*, const char*> ranges[] = {
      {"footprint", "1 to 16"},
      {"theta", "in [0, 90)"},
      {"fov", "in (0, 180)"},
      {"spacing", "above 0"},
      {"near", "0 or more"},
      {"azimuth", "finite"},
      {"eye-bits", "16 or 32"},
      {"brick-edge", "a multiple of 8 from 8 to 256, or 0 to have it chosen"},
      {"memory-budget", "1 to 2^40"},
      {"size", "at least 1 x 1"},
      {"eye", "three finite numbers"},
      {"ambient", "three finite numbers of 0 or more"},
      {"no-culling", ""},
  };
  for (const auto& [option, range] : ranges) {
    CAPTURE(option);
    CHECK(rangeText(*findSceneField(option)) == range);
  }
}
