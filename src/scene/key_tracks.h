// Keys of a scene in its JSON, and the numbers that keys set.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/json_reader.h"
#include "core/json_writer.h"
#include "scene/checker.h"
#include "umbrick/scene/scene.h"

namespace umbrick {

/// What a section has besides fields of the table that may have keys, by its name there.
struct KeyedPart {
  std::string_view key;
  std::function<void(const JsonValue& value, Scene& scene)> read;
  std::function<std::string(const Scene& scene)> print;
};
/// The parts of a section; empty: of the scene itself.
std::vector<KeyedPart> keyedParts(std::string_view section);

/// Returns the numbers that a scene has at the path of a track; empty where it has none there.
std::vector<double> numbersAt(const Scene& scene, std::string_view field);
/// Sets them. @throw InvalidArgument  the scene has no such field; another count of numbers
void setNumbers(Scene& scene, std::string_view field, const std::vector<double>& numbers);

/// Reads "keys" and "curve" of a section, if it has them, into the scene's tracks.
/// @param object  of the section, or of the scene itself, whose name is empty
void readKeys(const JsonValue& object, std::string_view section, Scene& scene);
/// Reads "keys" and "curve" of the transfer function. @param readFunction  reads the "function" of a key
void readTransferKeys(const JsonValue& object, Scene& scene,
                      const std::function<TransferFunction(const JsonValue&)>& readFunction);

/// Returns "keys" and "curve" of a section; nothing where it has none.
JsonFields printedKeys(std::string_view section, const Scene& scene);

/// Checks the tracks of a scene that was made by code; what a text gets wrong is told where it stands.
void checkTracks(Checker& check, const Scene& scene);

/// Returns the first field that is out of its range at a key, with its place among the keys: "camera.keys[2].fov".
std::optional<Complaint> findComplaintAtKeys(const Scene& scene);

}  // namespace umbrick
