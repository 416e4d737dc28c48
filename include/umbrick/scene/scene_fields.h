// The fields of a scene: one table that reader, writer, check, help texts and command line follow.
//
// A new field is two edits: a member in scene.h and a row in src/scene/scene_fields.cpp. Fields that are more than one
// value (transfer function, light sources, clip planes) are read and written by functions of their own.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "umbrick/scene/scene.h"

namespace umbrick {

/// An angle, which is in radians in memory and in degrees for users.
struct Angle {
  double* radians;
};

/// A picture's size, as two numbers in pixels.
struct PixelSize {
  int *width, *height;
};

/// A value that is one of a few names.
class Choice {
 public:
  template <class T, std::size_t N>
  Choice(T& target, const Name<T> (&names)[N])
      : target_(&target),
        names_(names),
        count_(N),
        nameAt_([](const void* list, std::size_t i) { return static_cast<const Name<T>*>(list)[i].first; }),
        isAt_([](const void* list, std::size_t i, const void* value) {
          return static_cast<const Name<T>*>(list)[i].second == *static_cast<const T*>(value);
        }),
        assign_([](const void* list, std::size_t i, void* value) {
          *static_cast<T*>(value) = static_cast<const Name<T>*>(list)[i].second;
        }) {}
  /// Makes a choice of a string that holds a name itself.
  template <std::size_t N>
  Choice(std::string& target, const std::string_view (&names)[N])
      : target_(&target),
        names_(names),
        count_(N),
        nameAt_([](const void* list, std::size_t i) { return static_cast<const std::string_view*>(list)[i]; }),
        isAt_([](const void* list, std::size_t i, const void* value) {
          return static_cast<const std::string_view*>(list)[i] == *static_cast<const std::string*>(value);
        }),
        assign_([](const void* list, std::size_t i, void* value) {
          *static_cast<std::string*>(value) = static_cast<const std::string_view*>(list)[i];
        }) {}

  std::vector<std::string> names() const;
  /// Returns the name of the present value; empty where the value has none.
  std::string_view get() const;
  /// Sets the value by its name. @return false  there is no such name
  bool set(std::string_view name) const;

 private:
  void* target_;
  const void* names_;
  std::size_t count_;
  std::string_view (*nameAt_)(const void*, std::size_t);
  bool (*isAt_)(const void*, std::size_t, const void*);
  void (*assign_)(const void*, std::size_t, void*);
};

/// The place of a field's value in a scene; monostate where the scene has no such field, for example the azimuth where
/// the camera is placed by its eye.
using FieldPlace = std::variant<std::monostate, double*, Angle, int*, std::uint64_t*, bool*, Choice, glm::dvec2*,
                                glm::dvec3*, std::optional<glm::dvec3>*, PixelSize>;

/// The range of a number, or of each component of a vector. Numbers are always finite.
struct FieldRange {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool lowOpen = false, highOpen = false;  // whether the ends themselves are excluded
  int multipleOf = 1;
  std::optional<double> orElse = {};  // a value outside the range that has a meaning of its own
  bool endsOnly = false;              // whether only low and high are allowed and nothing between
};

struct SceneField {
  std::string_view path;  // in the JSON: "occlusion.footprint"
  /// A name that is unique among all fields, for command lines: "footprint"; empty: none. The option of a boolean turns
  /// it to the opposite of its default: "no-culling".
  std::string_view option;
  std::string_view group;  // heading under which help lists the field: "Light"
  std::string_view help;   // what the field is, with its unit: "n: n x n samples over the cone's footprint"
  FieldPlace (*place)(Scene&);
  FieldRange range = {};
  std::vector<Method> onlyOf = {};  // the only methods of occlusion that look at the field; none: all
  std::string_view otherwise = {};  // what help says instead of a default: ": chosen by itself"

  /// Returns the section, such as "occlusion" for "occlusion.footprint"; empty for a field of the scene itself.
  std::string_view section() const;
  std::string_view key() const;
};

/// Returns all fields, in the order in which scenes are printed and checked.
std::span<const SceneField> sceneFields();
/// Returns the field of an option or of a path; null for none.
const SceneField* findSceneField(std::string_view optionOrPath);

/// Sets a field to a value that is written as in the JSON of a scene. Its range is checked by validateScene().
/// @param source  what messages call the text
/// @throw IoError  malformed JSON, or a value of another kind
void readSceneField(const SceneField& field, std::string_view json, const std::string& source, Scene& scene);

/// Returns "1 to 16", "in [0, 90)", "above 0", "16 or 32"; empty where there is nothing to say.
std::string rangeText(const SceneField& field);
/// Returns the text of the default, as in the JSON.
std::string defaultText(const SceneField& field);
/// Returns a line of help: "n: n x n samples over the cone's footprint, 1 to 16 [3]"
std::string helpText(const SceneField& field);

}  // namespace umbrick
