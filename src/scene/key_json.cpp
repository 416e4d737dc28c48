// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <set>

#include "scene/field_json.h"
#include "scene/field_text.h"
#include "scene/key_tracks.h"
#include "umbrick/scene/scene_fields.h"

namespace umbrick {
namespace {

std::string pathOf(std::string_view section, std::string_view key) {
  return section.empty() ? std::string(key) : std::string(section) + "." + std::string(key);
}

// Reads what all lists of keys have: their curve, and a frame each, in order.
// @param readKey  reads the rest of a key
void readKeyList(const JsonValue& object, KeyCurve& curve,
                 const std::function<void(const JsonValue& key, double frame)>& readKey) {
  const auto keys = object.find("keys");
  if (const auto name = object.find("curve")) {
    if (!keys) name->fail("is the way between 'keys', and there are none");
    curve = parseName(kKeyCurves, name->oneOf(listNames(kKeyCurves)), "curve");
  }
  if (!keys) return;
  const std::vector<JsonValue> items = keys->items();
  if (items.empty()) keys->failExpected("one key or more");
  std::optional<double> last;
  for (const JsonValue& key : items) {
    const JsonValue at = key.at("frame");
    const double frame = at.number();
    if (last && frame <= *last)
      at.fail("expected keys in ascending order, found frame " + jsonNumber(frame) + " after frame " +
              jsonNumber(*last));
    last = frame;
    readKey(key, frame);
  }
}

// What the keys of a section have found so far.
class SectionKeys {
 public:
  SectionKeys(std::string_view section, const Scene& scene) : section_(section), scene_(scene) {}

  // @param read  sets the value of the key in a scene
  void add(const JsonValue& value, std::string_view key, double frame, const std::function<void(Scene&)>& read) {
    Scene probe = scene_;
    read(probe);
    const std::string field = pathOf(section_, key);
    const std::vector<double> numbers = numbersAt(probe, field);
    if (numbers.empty()) value.fail("cannot have keys: it is no number, vector or list of them that this scene has");
    SceneTrack& track = tracks_[field];
    track.field = field;
    if (!track.keys.empty() && track.keys.front().numbers.size() != numbers.size())
      value.fail("expected as many as at frame " + jsonNumber(track.keys.front().frame));
    track.keys.push_back({.frame = frame, .numbers = numbers});
  }
  void appendTo(std::vector<SceneTrack>& tracks, KeyCurve curve) {
    for (auto& [field, track] : tracks_) {
      track.curve = curve;
      tracks.push_back(std::move(track));
    }
  }

 private:
  std::string_view section_;
  const Scene& scene_;
  std::map<std::string, SceneTrack> tracks_;
};

JsonFields printedTransferKeys(const SceneTrack& track) {
  std::vector<std::string> keys;
  for (const SceneTrack::Key& key : track.keys)
    keys.push_back(jsonObject({{"frame", jsonNumber(key.frame)}, {"function", printTransferFunction(*key.transfer)}}));
  return {{"keys", jsonArray(keys)}, {"curve", jsonString(std::string(nameOf(kKeyCurves, track.curve)))}};
}

// Prints the value of a track at one of its keys.
std::string printedAt(const SceneTrack& track, const SceneTrack::Key& key, std::string_view name, const Scene& scene,
                      const std::vector<KeyedPart>& parts) {
  Scene probe = scene;
  setNumbers(probe, track.field, key.numbers);
  for (const KeyedPart& part : parts)
    if (part.key == name) return part.print(probe);
  return jsonText(findSceneField(track.field)->place(probe));
}

}  // namespace

void readKeys(const JsonValue& object, std::string_view section, Scene& scene) {
  const std::vector<KeyedPart> parts = keyedParts(section);
  std::vector<std::string_view> known{"frame"};
  for (const SceneField& field : sceneFields())
    if (field.section() == section) known.push_back(field.key());
  for (const KeyedPart& part : parts) known.push_back(part.key);
  KeyCurve curve = KeyCurve::smooth;
  SectionKeys found(section, scene);
  readKeyList(object, curve, [&](const JsonValue& key, double frame) {
    key.allowFields(known);
    for (const SceneField& field : sceneFields())
      if (field.section() == section)
        if (const auto value = key.find(field.key()))
          found.add(*value, field.key(), frame, [&](Scene& probe) { readField(*value, field.place(probe)); });
    for (const KeyedPart& part : parts)
      if (const auto value = key.find(part.key))
        found.add(*value, part.key, frame, [&](Scene& probe) { part.read(*value, probe); });
  });
  found.appendTo(scene.tracks, curve);
}

void readTransferKeys(const JsonValue& object, Scene& scene,
                      const std::function<TransferFunction(const JsonValue&)>& readFunction) {
  object.allowFields({"keys", "curve"});
  SceneTrack track{.field = "transfer", .keys = {}};
  readKeyList(object, track.curve, [&](const JsonValue& key, double frame) {
    key.allowFields({"frame", "function"});
    const JsonValue function = key.at("function");
    TransferFunction transfer = readFunction(function);
    if (!track.keys.empty()) {
      try {
        mixed(*track.keys.back().transfer, transfer, 0.5);
      } catch (const InvalidArgument& error) {
        function.fail(error.what());
      }
    }
    track.keys.push_back({.frame = frame, .transfer = std::move(transfer)});
  });
  scene.transfer = track.keys.front().transfer;
  scene.tracks.push_back(std::move(track));
}

JsonFields printedKeys(std::string_view section, const Scene& scene) {
  const std::vector<KeyedPart> parts = keyedParts(section);
  std::map<double, JsonFields> keys;
  std::optional<KeyCurve> curve;
  for (const SceneTrack& track : scene.tracks) {
    if (track.field == "transfer") {
      if (section == "transfer") return printedTransferKeys(track);
      continue;
    }
    const std::size_t dot = track.field.find('.');
    const bool root = dot == std::string::npos;
    if ((root ? std::string_view() : std::string_view(track.field).substr(0, dot)) != section) continue;
    const std::string name = root ? track.field : track.field.substr(dot + 1);
    curve = track.curve;
    for (const SceneTrack::Key& key : track.keys) {
      JsonFields& fields = keys[key.frame];
      if (fields.empty()) fields.emplace_back("frame", jsonNumber(key.frame));
      fields.emplace_back(name, printedAt(track, key, name, scene, parts));
    }
  }
  if (!curve) return {};
  std::vector<std::string> printed;
  for (const auto& [frame, fields] : keys) printed.push_back(jsonObject(fields));
  return {{"keys", jsonArray(printed)}, {"curve", jsonString(std::string(nameOf(kKeyCurves, *curve)))}};
}

}  // namespace umbrick
