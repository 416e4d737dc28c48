// SPDX-License-Identifier: Apache-2.0
#include "scene/key_tracks.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/overload.h"
#include "scene/field_json.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/scene_fields.h"

namespace umbrick {
namespace {

std::vector<double> numbersOf(const FieldPlace& place) {
  return std::visit(Overload{[](double* value) { return std::vector{*value}; },
                             [](const Angle& angle) { return std::vector{*angle.radians}; },
                             [](int* value) { return std::vector{static_cast<double>(*value)}; },
                             [](glm::dvec2* v) {
                               return std::vector{v->x, v->y};
                             },
                             [](glm::dvec3* v) {
                               return std::vector{v->x, v->y, v->z};
                             },
                             [](std::optional<glm::dvec3>* v) {
                               return *v ? std::vector{(*v)->x, (*v)->y, (*v)->z} : std::vector<double>();
                             },
                             [](const auto&) { return std::vector<double>(); }},
                    place);
}

// Returns how many numbers a place takes; 0: it takes none.
std::size_t countOf(const FieldPlace& place) {
  return std::holds_alternative<std::optional<glm::dvec3>*>(place) ? 3 : numbersOf(place).size();
}

void storeNumbers(const FieldPlace& place, const std::vector<double>& n) {
  std::visit(Overload{[&](double* value) { *value = n[0]; }, [&](const Angle& angle) { *angle.radians = n[0]; },
                      [&](int* value) { *value = static_cast<int>(std::lround(n[0])); },
                      [&](glm::dvec2* v) {
                        *v = {n[0], n[1]};
                      },
                      [&](glm::dvec3* v) {
                        *v = {n[0], n[1], n[2]};
                      },
                      [&](std::optional<glm::dvec3>* v) { *v = glm::dvec3(n[0], n[1], n[2]); }, [](const auto&) {}},
             place);
}

// Whether what is wrong with a field may come from its keys.
bool concerns(const std::vector<SceneTrack>& tracks, const std::string& field) {
  return std::ranges::any_of(tracks, [&](const SceneTrack& track) {
    return track.field.starts_with(field) || field.starts_with(track.field);
  });
}

void readKeyedSurfaces(const JsonValue& value, Scene& scene) {
  readSurfaces(value, scene);
  for (const JsonValue& surface : value.items())
    if (const auto colour = surface.find("colour"))
      colour->fail("cannot have keys: surfaces have the colours of the scene's own 'surfaces' at all frames");
}

std::string printedKeyedSurfaces(const Scene& scene) {
  Scene plain = scene;
  for (SceneSurface& surface : plain.surfaces) surface.colour.reset();
  return printedSurfaces(plain);
}

// The value and opacity of each surface: their colours stay.
constexpr std::size_t kSurfaceNumbers = 2;

}  // namespace

std::vector<double> numbersAt(const Scene& given, std::string_view field) {
  std::vector<double> numbers;
  if (field == "clip.planes") {
    for (const ClipPlane& p : given.clipPlanes) numbers.insert(numbers.end(), {p.x, p.y, p.z, p.w});
  } else if (field == "clip.box") {
    if (const auto& box = given.clipBox)
      numbers = {box->min.x, box->min.y, box->min.z, box->max.x, box->max.y, box->max.z};
  } else if (field == "surfaces") {
    for (const SceneSurface& surface : given.surfaces) numbers.insert(numbers.end(), {surface.value, surface.opacity});
  } else if (const SceneField* known = findSceneField(field); known && known->path == field) {
    Scene scene = given;  // a copy, since a field's place is that of a scene that may be changed
    return numbersOf(known->place(scene));
  }
  return numbers;
}

void setNumbers(Scene& scene, std::string_view field, const std::vector<double>& numbers) {
  const auto requireCount = [&](bool right) {
    if (!right)
      throw InvalidArgument(std::string(field) + ": its keys have " + std::to_string(numbers.size()) +
                            " numbers, which do not fit the scene");
  };
  if (field == "clip.planes") {
    requireCount(numbers.size() % 4 == 0);
    scene.clipPlanes.clear();
    for (std::size_t i = 0; i < numbers.size(); i += 4)
      scene.clipPlanes.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]);
  } else if (field == "clip.box") {
    requireCount(numbers.size() == 6);
    Box& box = scene.clipBox.emplace();
    box.min = {numbers[0], numbers[1], numbers[2]};
    box.max = {numbers[3], numbers[4], numbers[5]};
  } else if (field == "surfaces") {
    requireCount(numbers.size() % kSurfaceNumbers == 0);
    scene.surfaces.resize(numbers.size() / kSurfaceNumbers);
    for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
      scene.surfaces[i].value = numbers[i * kSurfaceNumbers];
      scene.surfaces[i].opacity = numbers[i * kSurfaceNumbers + 1];
    }
  } else {
    const SceneField* known = findSceneField(field);
    const FieldPlace place = known && known->path == field ? known->place(scene) : FieldPlace();
    requireCount(!numbers.empty() && countOf(place) == numbers.size());
    storeNumbers(place, numbers);
  }
}

std::vector<KeyedPart> keyedParts(std::string_view section) {
  if (section == "clip") return {{"planes", readClipPlanes, printedClipPlanes}, {"box", readClipBox, printedClipBox}};
  if (section.empty()) return {{"surfaces", readKeyedSurfaces, printedKeyedSurfaces}};
  return {};
}

void checkTracks(Checker& check, const Scene& scene) {
  std::set<std::string> seen;
  for (const SceneTrack& track : scene.tracks) {
    check.require(seen.insert(track.field).second, track.field, "in two lists of keys", "in one");
    check.require(!track.keys.empty(), track.field, "without a key", "with one or more");
    for (std::size_t i = 0; i < track.keys.size(); ++i) {
      const SceneTrack::Key& key = track.keys[i];
      check.require(std::isfinite(key.frame), track.field, "at frame " + std::to_string(key.frame), "at finite ones");
      if (i > 0)
        check.require(track.keys[i - 1].frame < key.frame, track.field,
                      "at frame " + print(key.frame) + " after frame " + print(track.keys[i - 1].frame),
                      "in ascending order");
      const bool function = track.field == "transfer";
      check.require(key.transfer.has_value() == function && key.numbers.empty() == function &&
                        key.numbers.size() == track.keys.front().numbers.size(),
                    track.field, "of " + std::to_string(key.numbers.size()) + " numbers at frame " + print(key.frame),
                    function ? "a function" : "of as many as at frame " + print(track.keys.front().frame));
    }
    const auto sectionOf = [](const std::string& field) { return field.substr(0, field.find('.') + 1); };
    for (const SceneTrack& other : scene.tracks)
      check.require(sectionOf(other.field) != sectionOf(track.field) || other.curve == track.curve, track.field,
                    std::string(nameOf(kKeyCurves, track.curve)), "of the same curve as " + other.field);
  }
}

std::optional<Complaint> findComplaintAtKeys(const Scene& scene) {
  for (const SceneTrack& track : scene.tracks)
    for (const SceneTrack::Key& key : track.keys) {
      const std::optional<Complaint> complaint = findComplaint(sceneAt(scene, key.frame));
      if (!complaint || !concerns(scene.tracks, complaint->field)) continue;
      // The frames of the section's keys are those of all its tracks.
      const std::size_t dot = complaint->field.find('.');
      const std::string section = dot == std::string::npos ? "" : complaint->field.substr(0, dot + 1);
      std::set<double> frames;
      for (const SceneTrack& other : scene.tracks)
        if (section.empty() ? other.field.find('.') == std::string::npos : other.field.starts_with(section))
          for (const SceneTrack::Key& otherKey : other.keys) frames.insert(otherKey.frame);
      const auto index = std::distance(frames.begin(), frames.find(key.frame));
      const std::string field = dot == std::string::npos ? complaint->field : complaint->field.substr(dot + 1);
      return Complaint{section + "keys[" + std::to_string(index) + "]." + field,
                       complaint->message + ", at frame " + print(key.frame)};
    }
  return {};
}

}  // namespace umbrick
